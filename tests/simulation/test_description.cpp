// A description that is wrong says where and why.
#include "simulated.h"

#include "data/temp_folder.h"
#include <hoist/data/load_error.h>
#include <hoist/simulation/suites.h>

#include <gtest/gtest.h>

namespace hoist {
namespace test {
namespace {

struct BadCase {
  const char* name;
  std::string yaml;
  std::string line;
  std::string reason; ///< a part of it
};

void
PrintTo(const BadCase& bad, std::ostream* out)
{
  *out << bad.name;
}

class BadDescription : public ::testing::TestWithParam<BadCase> {};

TEST_P(BadDescription, SaysLineAndReason)
{
  const BadCase& bad = GetParam();
  try {
    simulation::parseDescription(bad.yaml, "scene.yaml");
    FAIL() << "was accepted";
  }
  catch (const LoadError& error) {
    EXPECT_EQ(error.file(), "scene.yaml");
    EXPECT_EQ(error.position(), bad.line) << error.what();
    EXPECT_NE(error.reason().find(bad.reason), std::string::npos) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    Cases,
    BadDescription,
    ::testing::Values(
        BadCase{"not_yaml", "name: x\nthings: [", "2", "not YAML"},
        BadCase{"tabs", "camera:\n\tdistance: 2\n", "2", "not YAML"},
        BadCase{"no_map", "- 1\n- 2\n", "1", "map of settings"},
        BadCase{"empty", "", "", "map of settings"},
        BadCase{"unknown_key", "name: x\n\nlamps: 3\n", "3", "'lamps'"},
        BadCase{"unknown_nested", "camera:\n  zoom: 3\n", "2", "'zoom' of camera"},
        BadCase{"twice", "area: [2, 2]\narea: [3, 3]\n", "2", "given twice"},
        BadCase{"no_number", "camera:\n  distance: far\n", "2", "expected a number"},
        BadCase{"nan", "camera: {distance: .nan}\n", "1", "expected a number"},
        BadCase{"hex", "sensor: {kind: tof, width: 0x20}\n", "1", "expected a number"},
        BadCase{"limit", "sensor:\n  width: 1\n", "2", "between 16 and 8192"},
        BadCase{"fraction", "sensor: {width: 100.5}\n", "1", "whole number"},
        BadCase{"range", "camera:\n  distance: [3, 2]\n", "2", "lower end"},
        BadCase{"range_of_3", "camera:\n  distance: [1, 2, 3]\n", "2", "[low, high]"},
        BadCase{"sensor", "sensor: lidar\n", "1", "unknown sensor 'lidar'"},
        BadCase{"sensor_kind", "sensor:\n  kind: sonar\n", "2", "unknown sensor"},
        BadCase{"no_kind", "things:\n  - {count: 3}\n", "2", "needs a kind"},
        BadCase{"kind", "things:\n  - kind: box\n  - kind: dragon\n", "3", "'dragon'"},
        BadCase{"size", "things:\n  - {kind: box, size: [1, 2]}\n", "2", "expected 3"},
        BadCase{"texture", "ground:\n  texture: lava\n", "2", "unknown texture"},
        BadCase{"color", "ground:\n  color: [1, 2, 300]\n", "2", "between 0 and 255"},
        BadCase{"things", "things: {kind: box}\n", "1", "must be a list"},
        BadCase{"eye", "camera: {eye: [0, 0, 1]}\n", "1", "go together"},
        BadCase{"same", "camera: {eye: [0, 0, 1], target: [0, 0, 1]}\n", "1", "same"},
        BadCase{"name", "name: a/b\n", "1", "letters"},
        BadCase{"ranges", "sensor: {min_range: 3, max_range: 2}\n", "1", "below"},
        BadCase{"block", "sensor: {kind: stereo, block_size: 4}\n", "1", "odd"},
        BadCase{"baseline", "sensor: {kind: stereo, baseline: 0}\n", "1", "baseline"},
        BadCase{"split", "things:\n  - {kind: chair, split: all}\n", "2", "train"}),
    [](const ::testing::TestParamInfo<BadCase>& one) { return one.param.name; });

TEST(Description, MissingFileSaysSo)
{
  const TempFolder folder;
  EXPECT_THROW(simulation::loadDescription(folder.name("none.yaml")), LoadError);
}

TEST(Description, CenterOfAnotherImageSizeIsItsMiddle)
{
  const auto d = simulation::parseDescription(
      "sensor: {kind: kinect, width: 320, height: 240, fx: 262.5}\n", "x.yaml");
  EXPECT_DOUBLE_EQ(d.sensor.camera.cx, 159.5);
  EXPECT_DOUBLE_EQ(d.sensor.camera.cy, 119.5);
  EXPECT_DOUBLE_EQ(d.sensor.camera.fy, 262.5);
}

TEST(Suites, AllCanBeReadAndShowThings)
{
  for (const simulation::Suite& suite : simulation::suites()) {
    SCOPED_TRACE(suite.name);
    const auto description = simulation::parseDescription(suite.yaml, suite.name);
    EXPECT_EQ(description.name, suite.name);
    std::size_t annotated = 0;
    for (int number = 0; number < 5; ++number)
      for (const auto& thing :
           simulation::makeScene(description, suite.seed, number).things)
        annotated += thing.annotated ? 1 : 0;
    EXPECT_GE(annotated, 10U);
  }
}

} // namespace
} // namespace test
} // namespace hoist
