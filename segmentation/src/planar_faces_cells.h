#pragma once

#include "planar_faces_moments.h"

#include <opencv2/core.hpp>

#include <cstdint>
#include <vector>

namespace hoist {
namespace detail {

/** \brief A window of cells. */
struct CellWindow {
  int column, row, width, height;
};

/** \brief Sums over the positions of a cell's measured pixels, from its first pixel. */
struct PositionSums {
  int n = 0, u = 0, v = 0, uu = 0, uv = 0, vv = 0;
};

/** \brief The image in cells of 4 x 4 pixels: what a plane test or fit needs of them,
 * so that no pixel is looked at again.
 *
 * Cells are numbered row by row, and there are unused cells around the grid so that
 * all neighbours of a cell exist: see \ref index. Pixels right and below of the last
 * full cell belong to none. */
struct CellGrid {
  static constexpr int size = 4; ///< [px]
  static constexpr int min_pixels = size * size / 2;
  static constexpr std::uint16_t full = 0xffff;

  /// Mean inverse depth of a cell's measured pixels, and mean products about the mean:
  /// so small that single precision keeps all that a sensor tells.
  struct Cell {
    float w = 0, uw = 0, vw = 0, ww = 0;
  };

  int columns = 0, rows = 0;
  int stride = 0;                      ///< from a cell to the one below
  std::vector<std::uint16_t> measured; ///< bit 4 y + x for pixel (x, y) of the cell
  std::vector<Cell> cells;             ///< zero where nothing is measured

  /** \param inverse_depth [1/m], 0 where not measured */
  void assign(const cv::Mat1f& inverse_depth);

  int
  index(int column, int row) const
  {
    return (row + 1) * stride + column + 1;
  }

  /** \brief For any pattern of measured pixels; slow beside the constants of a full
   * cell. */
  static PositionSums positions(std::uint16_t measured);

  bool
  isFull(int cell) const
  {
    return measured[cell] == full;
  }

  /** \brief Sums over a window, in image coordinates. */
  PlaneMoments moments(const CellWindow& window) const;

  /** \brief Sums over pixels of one cell, in image coordinates.
   *  \param cell mean and products of those pixels */
  static PlaneMoments
  moments(const Cell& cell, const PositionSums& positions, int column, int row);

private:
  void sumColumns(const cv::Mat1f& inverse_depth, int row);
  void sumCell(int cell, int column);

  // of a row of cells, pixel column by pixel column
  std::vector<double> column_w_, column_vw_, column_ww_;
  std::vector<int> column_measured_;
};

/** \brief Sums over full cells, for their moments: those of positions follow from the
 * cells' own. Coordinates count cells. */
struct FullCellSums {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  double w = 0, xw = 0, yw = 0, uw = 0, vw = 0, ww = 0;

  void
  add(const CellGrid::Cell& cell, int column, int row)
  {
    const double cx = column, cy = row, cw = cell.w;
    n += 1;
    x += cx;
    y += cy;
    xx += cx * cx;
    xy += cx * cy;
    yy += cy * cy;
    w += cw;
    xw += cx * cw;
    yw += cy * cw;
    uw += cell.uw;
    vw += cell.vw;
    ww += cell.ww + cw * cw;
  }

  /** \brief In image coordinates. */
  PlaneMoments moments() const;
};

} // namespace detail
} // namespace hoist
