#pragma once

#include "scene.h"

#include <Eigen/Core>

#include <limits>

namespace hoist {
namespace samples {

/** \brief Where a ray meets the scene. */
struct Hit {
  double distance = std::numeric_limits<double>::infinity(); ///< in ray lengths
  /// Boxes, then cylinders, then patches, in the scene's order; -1 for nothing.
  int object = -1;
  /// Box: +axis 0, -axis 0, +axis 1, ...; cylinder: 0 side, 1 and 2 ends; patch: 0.
  int face = 0;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero(); ///< unit, towards the ray's origin
  double s = 0, t = 0;                              ///< position on the face [m]
  Eigen::Vector2d half = Eigen::Vector2d::Zero();   ///< half the face's sides [m]
};

/** \brief The nearest meeting of the ray origin + distance * direction, distance > 0,
 *  with anything in the scene. */
Hit cast(const Scene& scene,
         const Eigen::Vector3d& origin,
         const Eigen::Vector3d& direction);

/** \brief The same with one box alone; false if the ray misses it. */
bool cast(const Box& box,
          const Eigen::Vector3d& origin,
          const Eigen::Vector3d& direction,
          Hit& hit);

/** \brief Whether anything lies on the segment between the two points. */
bool
blocked(const Scene& scene, const Eigen::Vector3d& from, const Eigen::Vector3d& to);

} // namespace samples
} // namespace hoist
