#pragma once

#include <Eigen/Core>

#include <cstdint>

namespace hoist {
namespace simulation {

/** \brief Smooth noise in [0, 1) on a lattice of unit cells, mean 1/2. */
double latticeNoise(const Eigen::Vector3d& p, std::uint64_t seed);

/** \brief Noise of several octaves in about [0, 1], mean 1/2.
 *
 * \param p place [m] \param size of the coarsest lumps [m] \param octaves each half the
 *        size and 0.7 of the height of the one before
 * \param footprint width of a pixel [m]: octaves finer than that are left out, as a
 *        lens would average them
 */
double fractalNoise(const Eigen::Vector3d& p,
                    double size,
                    int octaves,
                    double footprint,
                    std::uint64_t seed);

/** \brief 1 for detail of \a size much coarser than the pixel, falling to 0 where it is
 *  finer. */
double visible(double size, double footprint);

} // namespace simulation
} // namespace hoist
