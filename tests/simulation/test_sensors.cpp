// What sensors do to depth follows the laws that their models state.
#include "simulated.h"

#include <hoist/simulation/measure.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace hoist {
namespace test {
namespace {

using simulation::Frame;
using simulation::Sensor;
using simulation::SensorKind;

struct Moments {
  double mean = 0, deviation = 0;
  std::size_t count = 0, holes = 0;
};

// Of measured minus exact depth, away from the image's border.
Moments
errors(const Frame& frame)
{
  std::vector<double> list;
  Moments m;
  for (int v = 5; v < frame.depth.rows - 5; ++v)
    for (int u = 5; u < frame.depth.cols - 5; ++u) {
      if (std::isfinite(frame.depth(v, u)))
        list.push_back(frame.depth(v, u) - frame.exact.depth(v, u));
      else
        ++m.holes;
    }
  m.count = list.size();
  for (const double e : list)
    m.mean += e / static_cast<double>(list.size());
  for (const double e : list)
    m.deviation += (e - m.mean) * (e - m.mean) / static_cast<double>(list.size());
  m.deviation = std::sqrt(m.deviation);
  return m;
}

TEST(SigmaZ, IsNguyensForTheKinect)
{
  const Sensor kinect = Sensor::kinect();
  // the table of Nguyen et al. at normal incidence, by its formula
  EXPECT_NEAR(simulation::sigmaZ(kinect, 1, 1), 0.0012 + 0.0019 * 0.36, 1e-7);
  EXPECT_NEAR(simulation::sigmaZ(kinect, 3, 1), 0.0012 + 0.0019 * 6.76, 1e-7);
  const double t = M_PI / 3, ratio = t / (M_PI / 2 - t);
  EXPECT_NEAR(simulation::sigmaZ(kinect, 1, std::cos(t)),
              0.0012 + 0.0019 * 0.36 + 0.0001 * ratio * ratio,
              1e-6); // the arc cosine is good to 7e-5
}

class WallNoise : public ::testing::TestWithParam<std::pair<const char*, double>> {};

TEST_P(WallNoise, HasTheModelsDeviationAndNoBias)
{
  const auto [sensor, distance] = GetParam();
  const simulation::Scene scene = sceneOf(
      wallYaml("{kind: " + std::string(sensor) + ", width: 320, height: 240, fx: 525}",
               distance));
  const Frame frame = simulation::simulate(scene);
  const Moments m = errors(frame);
  ASSERT_EQ(m.holes, 0U); // a wall without edges, square to the camera
  double sigma = simulation::sigmaZ(scene.sensor, distance, 1);
  if (scene.sensor.kind == SensorKind::tof) {
    // dark surfaces echo less: the wall's albedo of 150 is 0.30 of 0.25
    const double echo = simulation::linear({{150, 150, 150}}).mean() / 0.25;
    sigma *= std::clamp(1 / std::sqrt(echo + 1e-3), 0.7, 3.0);
  }
  // 71300 pixels of which about 5 share their noise: 1 % of statistics; the slant of
  // the outer rays (up to 21 degrees) and the steps of the disparity take the rest
  EXPECT_NEAR(m.deviation, sigma, 0.05 * sigma);
  // z is convex in the disparity: sigma^2 / z, and five deviations of the mean
  EXPECT_NEAR(m.mean, 0, sigma * sigma / distance + 5 * sigma / std::sqrt(71300.0 / 5));
}

INSTANTIATE_TEST_SUITE_P(Distances,
                         WallNoise,
                         ::testing::Values(std::make_pair("kinect", 0.8),
                                           std::make_pair("kinect", 1.5),
                                           std::make_pair("kinect", 3.0),
                                           std::make_pair("tof", 2.0),
                                           std::make_pair("tof", 6.0)));

TEST(Kinect, DepthsAreStepsOfTheDisparity)
{
  const simulation::Scene scene =
      sceneOf(wallYaml("{kind: kinect, width: 160, height: 120, fx: 525}", 2));
  const Frame frame = simulation::simulate(scene);
  for (const float z : frame.depth) {
    const double steps = 580 * 0.075 / z / 0.125;
    EXPECT_NEAR(steps, std::round(steps), 1e-3); // a float of 2 m: 1e-7 of 174 steps
  }
}

const char* const plate = R"(
camera: {eye: [0, 0, 50], target: [0, 1, 50], roll: 0}
things:
  - {kind: box, size: [60, 1, 60], at: [0, 2.5], heading: 0, lift: 20, wear: 0, color: [160, 160, 160]}
  - {kind: box, size: [0.4, 0.02, 0.4], at: [0, 1.01], heading: 0, lift: 49.8, wear: 0, color: [160, 160, 160]}
)";

TEST(Kinect, ShadowLiesWhereTheProjectorCannotSee)
{
  const Frame frame = simulation::simulate(sceneOf(
      std::string("sensor: {kind: kinect, lateral: 0, edge_loss: 0}\n") + plate));
  // a plate of half width 0.2 m at 1 m before a wall at 2 m; the projector stands 75 mm
  // to the right of the eye, so the wall's shadow is on the plate's left:
  // from u = cx - f 0.2 to the ray from the projector past the edge, which meets the
  // wall at x = 2 (-0.2) - 0.075
  const int row = 240;
  const double edge = 319.5 - 525 * 0.2, end = 319.5 - 525 * (2 * 0.2 + 0.075) / 2;
  for (int u = 150; u < 320; ++u) {
    const bool hole = !std::isfinite(frame.depth(row, u));
    if (std::abs(u - edge) > 1 && std::abs(u - end) > 1) {
      EXPECT_EQ(hole, u > end && u < edge) << u;
    }
  }
  for (int u = 320; u < 500; ++u)
    EXPECT_TRUE(std::isfinite(frame.depth(row, u))) << u; // none on the right
}

TEST(Kinect, LosesEdgesAndGrazingSurfacesMoreThanOthers)
{
  const Frame edges = simulation::simulate(sceneOf(
      std::string("sensor: {kind: kinect, baseline: 0, edge_loss: 0.5}\n") + plate));
  int lost = 0, all = 0;
  for (int v = 100; v < 380; ++v)
    for (int u = 150; u < 490; ++u) {
      const int offset = std::abs(u - 319) - 105; // from the plate's upright edges
      if (std::abs(v - 240) < 95 && std::abs(offset) <= 2) {
        ++all;
        lost += std::isfinite(edges.depth(v, u)) ? 0 : 1;
      }
    }
  EXPECT_GT(lost, all / 5);
  EXPECT_LT(lost, all * 3 / 4);

  // the ground, seen flatter and flatter towards the horizon
  const Frame ground = simulation::simulate(sceneOf(R"(
sensor: {kind: kinect, max_range: 30}
camera: {eye: [0, 0, 0.6], target: [0, 3, 0.3], roll: 0}
)"));
  const auto holes = [&](double low, double high) {
    int hole = 0, count = 0;
    for (int v = 0; v < ground.depth.rows; ++v)
      for (int u = 0; u < ground.depth.cols; ++u) {
        const double c = ground.exact.cosine(v, u);
        if (c < low || c >= high)
          continue;
        ++count;
        hole += std::isfinite(ground.depth(v, u)) ? 0 : 1;
      }
    return static_cast<double>(hole) / std::max(1, count);
  };
  EXPECT_EQ(holes(0.45, 1), 0);
  EXPECT_GT(holes(0.15, 0.25), 0.2);
  EXPECT_GT(holes(0.15, 0.25), holes(0.3, 0.4));
}

TEST(Sensor, RegistrationShiftsColourAgainstDepth)
{
  const auto columnOfEdge = [&](const std::string& sensor) {
    const Frame frame = simulation::simulate(sceneOf(
        "sensor: {kind: ideal, vignetting: 0, color_noise: 0" + sensor + "}\n" + R"(
camera: {eye: [0, 0, 50], target: [0, 1, 50], roll: 0}
things:
  - {kind: box, size: [60, 1, 60], at: [0, 2.5], heading: 0, lift: 20, wear: 0, color: [220, 220, 220]}
  - {kind: box, size: [0.4, 0.02, 0.4], at: [0, 1.01], heading: 0, lift: 49.8, wear: 0, color: [30, 30, 30]}
)"));
    for (int u = 319; u < 639; ++u)
      if (frame.color(240, u)[1] > 2 * frame.color(240, 319)[1] + 10)
        return u;
    return -1;
  };
  const int exact = columnOfEdge("");
  EXPECT_NEAR(exact, 319.5 + 105, 1.5);
  // 10 mm to the right at 1 m: 5.25 px to the left
  EXPECT_NEAR(columnOfEdge(", registration_shift: [0.01, 0, 0]"), exact - 5.25, 1.5);
}

TEST(Tof, MixesBothSidesOfAnEdge)
{
  const Frame frame = simulation::simulate(sceneOf(
      std::string(
          "sensor: {kind: tof, noise: 0, edge_loss: 0, cx: 319.2, cy: 239.2}\n") +
      plate));
  int between = 0;
  for (const float z : frame.depth)
    between += z > 1.1f && z < 1.9f ? 1 : 0;
  EXPECT_GT(between, 100); // flying pixels around a plate with an outline of 840 px
  EXPECT_LT(between, 1700);
}

TEST(Stereo, ErrorGrowsWithTheSquareOfDistance)
{
  // disparity errors of a matcher do not depend on the distance of a textured wall
  std::vector<double> disparity;
  for (const double distance : {3.0, 6.0, 12.0}) {
    const Frame frame = simulation::simulate(sceneOf(wallYaml(
        "{kind: stereo, width: 512, height: 384, fx: 810, eye_misalignment: 0}",
        distance)));
    const double fb = 810 * 0.24;
    std::vector<double> list;
    for (int v = 20; v < 364; ++v)
      for (int u = 20; u < 360; ++u) // beyond is what the left eye does not see
        if (std::isfinite(frame.depth(v, u)))
          list.push_back(fb / frame.depth(v, u) - fb / frame.exact.depth(v, u));
    ASSERT_GT(list.size(), 344U * 340U * 8 / 10);
    std::nth_element(list.begin(), list.begin() + list.size() / 2, list.end());
    // the matcher's bias towards whole pixels is below a quarter of one
    EXPECT_NEAR(list[list.size() / 2], 0, 0.25) << distance;
    for (double& e : list)
      e = std::abs(e);
    std::nth_element(list.begin(), list.begin() + list.size() * 2 / 3, list.end());
    disparity.push_back(list[list.size() * 2 / 3]); // about one sigma
    EXPECT_LT(disparity.back(), 0.6) << distance;
  }
  EXPECT_LT(disparity[2], 4 * disparity[0]);
  EXPECT_LT(disparity[0], 4 * disparity[2]);
}

} // namespace
} // namespace test
} // namespace hoist
