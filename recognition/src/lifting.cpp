#include <hoist/recognition/lifting.h>

#include <limits>

namespace hoist {
namespace {

LiftPose
faceOf(const Cuboid& cuboid, int face)
{
  LiftPose pose;
  const int axis = face / 2;
  pose.face = face;
  pose.normal = cuboid.axes.col(axis) * (face % 2 == 0 ? 1.0 : -1.0);
  pose.point = cuboid.center + pose.normal * (0.5 * cuboid.size[axis]);
  pose.observed = cuboid.observed_faces[face];
  return pose;
}

template <typename Rank>
LiftPose
bestFace(const Cuboid& cuboid, const Rank& rank)
{
  LiftPose best;
  double best_rank = -std::numeric_limits<double>::infinity();
  for (int face = 0; face < 6; ++face) {
    const LiftPose pose = faceOf(cuboid, face);
    const double r = rank(pose);
    if (r > best_rank) {
      best_rank = r;
      best = pose;
    }
  }
  return best;
}

} // namespace

LiftPose
upwardFace(const Cuboid& cuboid, const Eigen::Vector3d& up)
{
  return bestFace(cuboid, [&](const LiftPose& pose) { return pose.normal.dot(up); });
}

LiftPose
cameraFacingFace(const Cuboid& cuboid)
{
  return bestFace(cuboid, [](const LiftPose& pose) {
    const double distance = pose.point.norm();
    return distance > 0 ? -pose.normal.dot(pose.point) / distance : 0.0;
  });
}

} // namespace hoist
