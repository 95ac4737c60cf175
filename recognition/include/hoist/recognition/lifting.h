#pragma once

#include <hoist/data/cuboid.h>
#include <hoist/recognition/export.h>

#include <Eigen/Core>

namespace hoist {

/** \brief Where a hook, a gripper or a vacuum lifter takes hold of a cuboid. */
struct LiftPose {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< centre of the face [m]
  Eigen::Vector3d normal = Eigen::Vector3d::Zero(); ///< its outward unit normal
  int face = 0;          ///< 0 .. 5, in the order of Cuboid::observed_faces
  bool observed = false; ///< the face was seen
};

/** \brief The face that looks up most. Ties go to the lower face number.
 *
 * \param up unit vector against gravity, in the camera frame
 */
HOIST_RECOGNITION_EXPORT LiftPose upwardFace(const Cuboid& cuboid,
                                             const Eigen::Vector3d& up);

/** \brief The face that looks to the camera (the frame's origin) most: the largest
 *  cosine between its normal and the direction from its centre to the camera. */
HOIST_RECOGNITION_EXPORT LiftPose cameraFacingFace(const Cuboid& cuboid);

} // namespace hoist
