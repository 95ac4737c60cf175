#include <hoist/recognition/surface.h>

#include <cmath>

namespace hoist {

double
distanceToSurface(const Cuboid& cuboid, const Eigen::Vector3d& point)
{
  // Signed distances to the three slabs, positive outside.
  const Eigen::Vector3d q =
      (cuboid.axes.transpose() * (point - cuboid.center)).cwiseAbs() -
      0.5 * cuboid.size;
  const double farthest = q.maxCoeff<Eigen::PropagateNaN>();
  if (!(farthest > 0))
    return std::abs(farthest);
  return q.cwiseMax(0.0).norm();
}

} // namespace hoist
