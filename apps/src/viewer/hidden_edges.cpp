#include "viewer/hidden_edges.h"

#include <hoist/data/cuboid.h>

#include <array>

namespace hoist {

int
hiddenEdges(const Eigen::Matrix<double, 3, 8>& corners,
            const Eigen::Vector3d& eye,
            bool parallel)
{
  // a face is seen if the eye is before it
  const Eigen::Vector3d center = corners.rowwise().mean();
  std::array<std::array<bool, 2>, 3> seen{}; // by axis, low and high side
  bool any = false;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d half = 0.5 * (corners.col(1 << axis) - corners.col(0));
    const double along = half.dot(parallel ? eye : Eigen::Vector3d(eye - center));
    const double reach = parallel ? 0 : half.squaredNorm();
    seen[axis] = {along<-reach, along> reach};
    any = any || seen[axis][0] || seen[axis][1];
  }
  if (!any)
    return 0;
  int hidden = 0, bit = 1;
  for (const auto& edge : Cuboid::edges()) {
    const int low = edge[0], along = edge[0] ^ edge[1];
    bool visible = false;
    for (int axis = 0; axis < 3; ++axis)
      if (along != 1 << axis) // one of the two faces that meet in this edge
        visible = visible || seen[axis][low >> axis & 1];
    if (!visible)
      hidden |= bit;
    bit <<= 1;
  }
  return hidden;
}

} // namespace hoist
