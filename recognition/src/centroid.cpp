#include <hoist/recognition/centroid.h>

namespace hoist {

Eigen::Vector3d
centroidFromVertex(const Eigen::Vector3d& vertex,
                   const std::array<Eigen::Vector3d, 3>& ends)
{
  Eigen::Vector3d path = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& end : ends)
    path += end - vertex;
  return vertex + 0.5 * path;
}

Eigen::Vector3d
centroidFromVertices(const Eigen::Vector3d& first_end,
                     const Eigen::Vector3d& second_end)
{
  return 0.5 * (first_end + second_end);
}

} // namespace hoist
