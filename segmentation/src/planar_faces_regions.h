#pragma once

#include "planar_faces_seeds.h"

#include <hoist/segmentation/planar_faces.h>

#include <limits>
#include <vector>

namespace hoist {
namespace detail {

/** \brief Flat regions of a cell grid. Keeps its buffers.
 *
 * Region r has number r + 1 in \ref owner, as labels have later. */
class CellRegions {
public:
  /// Numbers have to fit into a short.
  static constexpr std::size_t max_regions = 32766;

  std::vector<short> owner; ///< per cell of the grid; 0 free, -1 not usable
  std::vector<Eigen::Vector3d> planes;
  std::vector<PlaneMoments> sums;

  /** \brief Grows regions from the flattest windows of the grid, first large ones, and
   * merges neighbours on one plane. */
  void find(const CellGrid& grid,
            const InverseDepthNoise& noise,
            const PlanarFaceParameters& parameters,
            FlatWindows& windows);

private:
  struct Member {
    int cell, column, row;
  };
  // A test of cells against a plane, in single precision.
  struct Test;

  bool growFrom(const CellWindow& window, const CellGrid& grid);
  void flood(const CellWindow& window, const CellGrid& grid, const Test& test);
  PlaneMoments sumOfMembers(const CellGrid& grid) const;
  void mergeNeighbours(const CellGrid& grid);
  bool fitTogether(int a, int b, PlaneMoments& sum, Eigen::Vector3d& plane) const;

  InverseDepthNoise noise_;
  PlanarFaceParameters parameters_;
  std::vector<Member> members_; // of the region that grows: the first count_
  std::size_t count_ = 0;
  // per cell: the last round of growing that looked at it, or that none shall
  std::vector<int> last_round_;
  static constexpr int never = std::numeric_limits<int>::max();
  int round_ = 0;
  std::vector<short> parent_, marks_;
};

} // namespace detail
} // namespace hoist
