#include <hoist/simulation/suites.h>

#include <algorithm>

namespace hoist {
namespace simulation {
namespace {

// What a crane lifts, in a yard.
const char* const crane_things = R"(
things:
  - {kind: [slab, block, beam, column], count: [1, 2], timbers: 0.6}
  - {kind: [block, bricks, crate], count: [1, 3], touching: 0.2, timbers: 0.3}
  - {kind: [slab, block, crate, carton], count: [0, 2], stacked: 0.8}
  - {kind: carton, count: [0, 3], stacked: 0.3, touching: 0.3, size: [[0.4, 0.9], [0.3, 0.6], [0.25, 0.6]]}
  - {kind: [drum, pipe, rubble, sawhorse], count: [0, 2]}
  - {kind: [worker, post], count: [0, 1]}
)";

const char* const yard = R"(
ground: {texture: [concrete, asphalt, soil]}
walls: {count: [0, 1], distance: 4, height: 4}
light: {sun: 0.7, sun_elevation: [12, 65], sun_power: [1, 4]}
)";

const char* const worksite_things = R"(
things:
  - {kind: safety cone, count: [0, 2], tipped: 0.15, library: 0.1, split: SPLIT}
  - {kind: hard hat, count: [0, 2], tipped: 0.3, stacked: 0.4, split: SPLIT}
  - {kind: bucket, count: [0, 2], tipped: 0.1, split: SPLIT}
  - {kind: recycle bin, count: [0, 2], library: 0.3, split: SPLIT}
  - {kind: safety gloves, count: [0, 2], stacked: 0.4, library: 0.15, split: SPLIT}
  - {kind: gas container, count: [0, 2], tipped: 0.1, split: SPLIT}
  - {kind: chair, count: [0, 2], tipped: 0.05, library: 0.6, split: SPLIT}
  - {kind: plant, count: [0, 2], library: 0.5, split: SPLIT}
  - {kind: [carton, crate, block, bricks], count: [0, 3], stacked: 0.3, size: [[0.25, 0.8], [0.2, 0.6], [0.15, 0.6]]}
  - {kind: [drum, can, pipe, rubble, sawhorse], count: [0, 3]}
  - {kind: [worker, scaffold, post], count: [0, 1]}
)";

std::string
worksite(const std::string& name, const std::string& split)
{
  std::string things = worksite_things;
  for (std::size_t at = things.find("SPLIT"); at != std::string::npos;
       at = things.find("SPLIT"))
    things.replace(at, 5, split);
  return "name: " + name + R"(
sensor: {kind: kinect, exposure: [-0.8, 0.6], white_balance_error: 0.1, registration_error: 0.003, registration_turn_error: 0.15}
camera: {distance: [1.2, 3.6], elevation: [8, 50], roll: [-4, 4], target_jitter: 0.35}
area: [4.5, 4.5]
ground: {texture: [concrete, asphalt, soil, plaster, wood]}
walls: {count: [1, 4], distance: 0.8, height: 3}
light: {sun: 0.35, sun_elevation: [15, 60], sun_power: [0.5, 3], sky_power: [0.2, 1], lamps: [1, 3], lamp_power: [1, 6]}
)" + things;
}

std::vector<Suite>
makeSuites()
{
  return {
      {"crane-stereo",
       "lifting elements in a yard, Bumblebee-like stereo of 0.24 m at 3 to 15 m",
       200,
       51001,
       "pts",
       std::string(R"(name: crane-stereo
sensor: {kind: stereo, exposure: [-0.5, 0.4], white_balance_error: 0.05}
camera: {distance: [3, 15], elevation: [15, 65], roll: [-4, 4], target_jitter: 0.25}
area: [7, 7]
)") + yard +
           crane_things},
      {"crane-tof",
       "the same with a depth camera at 2.5 to 9 m",
       200,
       51002,
       "pcd",
       std::string(R"(name: crane-tof
sensor: {kind: tof, exposure: [-0.5, 0.4], white_balance_error: 0.05}
camera: {distance: [2.5, 9], elevation: [15, 65], roll: [-4, 4], target_jitter: 0.25}
area: [6, 6]
)") + yard +
           crane_things},
      {"table-kinect",
       "cartons and boxes on a table, Kinect at 0.8 to 1.8 m",
       200,
       51003,
       "pcd",
       R"(name: table-kinect
sensor: {kind: kinect, exposure: [-0.1, 0.6], white_balance_error: 0.08, registration_error: 0.002}
camera: {distance: [0.8, 1.8], elevation: [25, 60], roll: [-3, 3], target_jitter: 0.2}
table: [[1.1, 1.5], [0.7, 0.9], [0.7, 0.78]]
ground: {texture: [plaster, wood, concrete]}
walls: {count: [1, 3], distance: 1.6, height: 2.8}
area: [3, 3]
light: {sun: 0, sky_power: [0.8, 1.2], lamps: [1, 3], lamp_power: [1, 4]}
things:
  - {kind: carton, count: [1, 3], size: [[0.12, 0.35], [0.08, 0.25], [0.06, 0.25]], tipped: 0.2}
  - {kind: [carton, box], count: [0, 3], size: [[0.1, 0.3], [0.08, 0.2], [0.05, 0.2]], stacked: 0.4, touching: 0.3}
  - {kind: can, count: [0, 2]}
)"},
      {"worksite-train",
       "the eight classes with fullness, material and colour, to learn from",
       20000,
       52001,
       "compact",
       worksite("worksite-train", "train")},
      {"worksite-val",
       "the same shapes in other scenes, to choose a model by",
       1000,
       52002,
       "compact",
       worksite("worksite-val", "train")},
      {"worksite-test",
       "the same classes in shapes of which none is in train or val",
       1000,
       52003,
       "compact",
       worksite("worksite-test", "test")},
      {"site-revisit",
       "a robot's way through sites, two visits each, things new, moved and removed",
       240,
       53001,
       "compact",
       std::string(R"(name: site-revisit
sensor: {kind: kinect, exposure: [-0.4, 0.3], white_balance_error: 0.05}
camera: {distance: [2.2, 3.0], elevation: [18, 30]}
area: [5, 5]
ground: {texture: [concrete, plaster]}
walls: {count: 4, distance: 1.5, height: 3}
light: {sun: 0, sky_power: [0.4, 0.8], lamps: [2, 4], lamp_power: [2, 6]}
visits: {count: 2, frames: 30, new: 0.25, moved: 0.2, removed: 0.2}
things:
  - {kind: [block, crate, bricks], count: [2, 4], size: [[0.4, 0.9], [0.3, 0.6], [0.3, 0.7]]}
  - {kind: carton, count: [2, 4], stacked: 0.4}
  - {kind: [safety cone, bucket, gas container], count: [2, 4]}
  - {kind: [recycle bin, chair, plant], count: [2, 4]}
  - {kind: [hard hat, safety gloves], count: [1, 3], stacked: 0.5}
  - {kind: [drum, rubble, sawhorse], count: [0, 2]}
)")},
  };
}

} // namespace

const std::vector<Suite>&
suites()
{
  static const std::vector<Suite> all = makeSuites();
  return all;
}

const Suite*
findSuite(const std::string& name)
{
  const std::vector<Suite>& all = suites();
  const auto found = std::find_if(
      all.begin(), all.end(), [&](const Suite& suite) { return suite.name == name; });
  return found == all.end() ? nullptr : &*found;
}

} // namespace simulation
} // namespace hoist
