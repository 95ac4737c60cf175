#pragma once

#include <hoist/simulation/description.h>
#include <hoist/simulation/simulate.h>

#include <string>

namespace hoist {
namespace test {

/** \brief Frame \a number of a description in YAML. */
inline simulation::Scene
sceneOf(const std::string& yaml, std::uint64_t seed = 1, int number = 0)
{
  return simulation::makeScene(
      simulation::parseDescription(yaml, "test.yaml"), seed, number);
}

/** \brief A wall that fills the picture of a camera \a distance away, square to it. */
inline std::string
wallYaml(const std::string& sensor, double distance)
{
  return "sensor: " + sensor +
         "\n"
         "camera: {eye: [0, 0, 50], target: [0, 1, 50], roll: 0}\n"
         "light: {sun: 1, sun_elevation: 45, sun_power: 1, sky_power: 1}\n"
         "things:\n"
         "  - {kind: block, size: [60, 1, 60], at: [0, " +
         std::to_string(distance + 0.5) +
         "], heading: 0, lift: 20, wear: 0, color: [150, 150, 150]}\n";
}

} // namespace test
} // namespace hoist
