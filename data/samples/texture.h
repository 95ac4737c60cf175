#pragma once

#include "scene.h"

#include <Eigen/Core>

#include <cstdint>

namespace hoist {
namespace samples {

/** \brief The colour of a surface before light falls on it.
 *
 * \param s, t position on the face from its centre [m]
 * \param half half the face's side lengths [m]; infinite for a plane
 * \param seed differs from face to face, so that no two look the same
 * \return RGB, each in [0, 255]
 */
Eigen::Vector3d albedo(Texture texture,
                       const Rgb& base,
                       double s,
                       double t,
                       const Eigen::Vector2d& half,
                       std::uint64_t seed);

} // namespace samples
} // namespace hoist
