#pragma once

#include "planar_faces_cells.h"

#include <array>
#include <vector>

namespace hoist {
namespace detail {

/** \brief Finds the flat windows of a cell grid, and from the flattest of them how
 * noisy the frame is. Keeps its buffers.
 *
 * The flatness of a window is the mean square residual of its own plane over sigma
 * squared. */
class FlatWindows {
public:
  struct Seed {
    float flatness;
    int column, row;
  };

  /** \brief Looks at all windows of 4 x 4 cells, 16 x 16 pixels.
   *  \return factor on the noise so that it describes the frame: the lower quartile of
   *  rms over sigma, times two, within [0.05, 1] */
  double measure(const CellGrid& grid, const InverseDepthNoise& noise);

  /** \brief All windows of \a width x \a height cells that nobody owns and that are
   * flat, sorted coarsely into \ref bins.
   *  \param noise what \ref measure was given, times what it said
   *  \param owner per cell of the grid, 0 where free */
  void collect(const CellGrid& grid,
               const InverseDepthNoise& noise,
               const std::vector<short>& owner,
               int width,
               int height);

  /** \brief Number of groups that \ref bin tells. */
  static constexpr int bins = 256;

  /** \brief The seeds of a group whose first cell is still free, the flattest first;
   * groups ascend in flatness. */
  const std::vector<Seed>&
  bin(int number, const CellGrid& grid, const std::vector<short>& owner);

private:
  // Sums over four neighbouring cells of a row, for each first cell.
  struct RowSums {
    std::vector<double> w, uw, vw, ww;
    std::vector<std::uint16_t> measured;
  };

  void sumRow(const CellGrid& grid, int row);
  void fullWindows(const CellGrid& grid, const InverseDepthNoise& noise, int row);
  double noiseScale(const CellGrid& grid, const InverseDepthNoise& noise);

  std::array<RowSums, 4> ring_; // of the last four rows
  std::vector<float> large_;    // flatness of full large windows, -1 for others
  double scale_ = 1;
  std::vector<Seed> found_, sorted_, free_;
  std::array<int, bins + 1> first_{};
  std::vector<float> flattest_;
};

} // namespace detail
} // namespace hoist
