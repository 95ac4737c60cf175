#pragma once

#include <hoist/data/cuboid.h>
#include <hoist/recognition/export.h>

#include <Eigen/Core>

namespace hoist {

/** \brief Distance of a point from the surface of a cuboid [m], from inside or outside;
 *  NaN for a NaN point. */
HOIST_RECOGNITION_EXPORT double distanceToSurface(const Cuboid& cuboid,
                                                  const Eigen::Vector3d& point);

} // namespace hoist
