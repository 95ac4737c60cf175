#pragma once

#include <hoist/data/cuboid.h>
#include <hoist/data/frame_images.h>

#include <Eigen/Geometry>

#include <optional>
#include <vector>

namespace hoist {

/** \brief A line of sight in the frame of the sensor. */
struct SightLine {
  Eigen::Vector3d origin;
  Eigen::Vector3d way; ///< unit vector
  /// How much further from the line things count as met, per metre from the origin: the
  /// size of a few pixels of the view.
  double slope = 0;
};

/** \brief The pixel whose point is met: of those within the line's reach the nearest to
 *  the line where a surface is, not what lies behind it.
 *  \return v * width + u, or -1 if no point is met */
int pickPoint(const FrameImages& images, const SightLine& line);

/** \brief Which cuboid the line enters first; -1 if none. \a distance then is how far
 *  from the origin [m]. */
int pickCuboid(const std::vector<Cuboid>& cuboids,
               const SightLine& line,
               double* distance = nullptr);

} // namespace hoist
