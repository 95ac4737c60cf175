#pragma once

#include <hoist/data/annotation.h>
#include <hoist/data/cuboid.h>
#include <hoist/data/export.h>

#include <Eigen/Core>

#include <array>
#include <vector>

namespace hoist {

/** \brief A box and nothing else: full side lengths size(i) [m] along the columns of
 *  axes. */
struct OrientedBox {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();

  OrientedBox() = default;

  /** \param rotation_ its columns are the axes, orthonormal but for rounding and of
   *  either hand; the nearest rotation is taken, a left-handed one names the same box
   *  with its last axis turned round */
  HOIST_DATA_EXPORT OrientedBox(const Eigen::Vector3d& center_,
                                const Eigen::Vector3d& size_,
                                const Eigen::Matrix3d& rotation_);

  explicit OrientedBox(const Cuboid& cuboid)
  : center(cuboid.center), size(cuboid.size), axes(cuboid.axes)
  {
  }

  explicit OrientedBox(const AnnotatedObject& object)
  : OrientedBox(object.center, object.size, object.rotation)
  {
  }

  double
  volume() const
  {
    return size.prod();
  }
};

/** \brief Volume that two boxes share [m^3], exact but for rounding (1e-9 of the
 * sides).
 *
 * The faces of the shared body are the faces of one box cut to the inside of the other;
 * its volume follows from them by the divergence theorem.
 */
HOIST_DATA_EXPORT double intersectionVolume(const OrientedBox& a, const OrientedBox& b);

/** \brief Intersection over union of the volumes, in [0, 1]. */
HOIST_DATA_EXPORT double intersectionOverUnion(const OrientedBox& a,
                                               const OrientedBox& b);

/** \brief The 24 ways to name a box's axes: column i of each has +-1 in the row of the
 *  old axis that becomes axis i; determinant +1. */
HOIST_DATA_EXPORT const std::vector<Eigen::Matrix3d>& axisNamings();

/** \brief How far a found box is from the true one. */
struct BoxErrors {
  Eigen::Vector3d center =
      Eigen::Vector3d::Zero(); ///< found minus true, in the frame of both [m]
  Eigen::Vector3d size =
      Eigen::Vector3d::Zero(); ///< found minus true, along the true axes [m]
  double rotation = 0;         ///< angle between the axes [rad]
  /// Which of the found box's axes lies along true axis i.
  std::array<int, 3> axis = {0, 1, 2};
};

/** \brief Errors modulo what cannot be told apart.
 *
 * Of the 24 namings of the found box's axes the one with the smallest rotation to the
 * true box counts, and its sizes are compared. For a thing that looks the same when it
 * is turned about one of its axes, the rotation is the angle between those axes alone,
 * and the other two sides are assigned so that they fit best.
 */
HOIST_DATA_EXPORT BoxErrors boxErrors(const OrientedBox& found,
                                      const OrientedBox& truth,
                                      ObjectSymmetry symmetry = ObjectSymmetry::box);

} // namespace hoist
