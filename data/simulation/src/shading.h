#pragma once

#include <hoist/simulation/ray_caster.h>
#include <hoist/simulation/scene.h>

#include <Eigen/Core>

#include <vector>

namespace hoist {
namespace simulation {

/** \brief A place of a surface that is to be lit. World frame. */
struct Place {
  Eigen::Vector3d position;
  Eigen::Vector3d normal; ///< of the triangle, towards the eye
  Eigen::Vector3d shade;  ///< smooth normal, towards the eye
  Eigen::Vector3d view;   ///< unit, towards the eye
  double footprint;       ///< width of a pixel there [m]
};

/** \brief The place that a ray met. \param pixel_angle width of a pixel [rad] */
Place placeOf(const RayCaster& caster,
              const Eigen::Vector3d& origin,
              const Eigen::Vector3d& direction,
              const Hit& hit,
              double pixel_angle);

/** \brief How much of the sun and of every lamp reaches places: 0 or 1 each, sun first.
 *  \param count of the places, at most 4 \param visible a list for every place */
void directLight(const RayCaster& caster,
                 const Light& light,
                 const Place* places,
                 int count,
                 std::vector<float>* visible);

/** \brief How much of the sky above a place is open, [0, 1], from a few rays of at most
 *  \a reach [m]. \param number of the pixel, which turns the pattern of rays */
float openSky(const RayCaster& caster,
              const Place& place,
              double reach,
              std::uint64_t number);

/** \brief Light that leaves a place towards the eye, linear. */
Eigen::Vector3f shadeOf(const Scene& scene,
                        const Hit& hit,
                        const Place& place,
                        const std::vector<float>& direct,
                        float open);

/** \brief Light of the sky where a ray meets nothing. */
Eigen::Vector3f skyColor(const Light& light, const Eigen::Vector3d& direction);

} // namespace simulation
} // namespace hoist
