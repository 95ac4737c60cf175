#include <hoist/filters/depth_edges.h>

#include <samples/generate.h>
#include <samples/render.h>

#include <opencv2/imgproc.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <stdexcept>

namespace hoist {
namespace {

Intrinsics
camera(int width, int height)
{
  Intrinsics camera;
  camera.fx = camera.fy = 525.0 * width / 640;
  camera.cx = (width - 1) / 2.0;
  camera.cy = (height - 1) / 2.0;
  return camera;
}

cv::Mat1b
edges(const cv::Mat1f& w, int kinds, const DepthEdgeParameters& parameters = {})
{
  cv::Mat1b labels(w.size(), static_cast<unsigned char>(0));
  DepthEdges detector;
  detector.detect(w, camera(w.cols, w.rows), parameters, kinds, labels);
  return labels;
}

// The inverse depth of the nearer (convex fold) of planes n.X = offset, with normal
// noise of the sensor's sigma.
cv::Mat1f
planes(cv::Size size,
       const std::vector<Eigen::Vector4d>& all,
       const SensorModel* sensor,
       unsigned seed)
{
  const Intrinsics c = camera(size.width, size.height);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  cv::Mat1f w(size);
  for (int v = 0; v < size.height; ++v)
    for (int u = 0; u < size.width; ++u) {
      double nearest = INFINITY; // a convex solid shows its farthest cutting plane
      for (const auto& plane : all)
        nearest = std::min(nearest, plane.head<3>().dot(c.ray(u, v)) / plane[3]);
      double z = 1 / nearest;
      if (sensor != nullptr)
        z += sensor->sigmaZ(z) * normal(random);
      w(v, u) = z > 0 ? static_cast<float>(1 / z) : 0.0F; // behind the camera
    }
  return w;
}

// Two planes that meet at (0, 0, z) under 180 degrees - fold, symmetric to the camera;
// the crease is seen under `direction` (0: vertical) in the image.
cv::Mat1f
folded(cv::Size size,
       double z,
       double fold,
       double direction,
       bool noise,
       unsigned seed)
{
  const Eigen::Vector3d across(std::cos(direction), std::sin(direction), 0);
  std::vector<Eigen::Vector4d> all;
  for (const double side : {-1.0, 1.0}) {
    const Eigen::Vector3d n = std::cos(fold / 2) * Eigen::Vector3d::UnitZ() +
                              side * std::sin(fold / 2) * across;
    all.emplace_back(n.x(), n.y(), n.z(), n.z() * z);
  }
  const SensorModel sensor;
  return planes(size, all, noise ? &sensor : nullptr, seed);
}

TEST(InverseDepthNoise, IsTheSensorsSigmaForEveryKind)
{
  for (const SensorModel& sensor : {SensorModel::kinect(),
                                    SensorModel::stereo(100, 0.3),
                                    SensorModel::constant(0.004)}) {
    const InverseDepthNoise noise(sensor);
    for (double z = 0.3; z < 8; z *= 1.3)
      // float coefficients
      EXPECT_NEAR(noise(static_cast<float>(1 / z)),
                  sensor.sigmaZ(z) / (z * z),
                  1e-5 * (1 + 1 / (z * z)));
  }
}

// A frontal box at 0.8 m before a wall at 1.5 m.
const cv::Rect box(200, 120, 180, 140);

cv::Mat1f
boxBeforeWall()
{
  cv::Mat1f w(480, 640, 1 / 1.5F);
  w(box) = 1 / 0.8F;
  return w;
}

// The outermost pixels of the box.
cv::Mat1b
outline()
{
  cv::Mat1b expected(480, 640, static_cast<unsigned char>(0));
  cv::rectangle(expected, box, EDGE_OCCLUSION);
  return expected;
}

TEST(OcclusionEdges, LieExactlyOnTheNearSide)
{
  const cv::Mat1b labels = edges(boxBeforeWall(), EDGE_OCCLUSION);
  EXPECT_EQ(cv::countNonZero(labels != outline()), 0);
}

TEST(OcclusionEdges, AShadowOfUnmeasuredPixelsBelongsToTheFarSide)
{
  cv::Mat1f w = boxBeforeWall();
  // what a projector 7.5 cm to the right leaves dark: f B (1/0.8 - 1/1.5) = 23 px
  w(cv::Rect(box.x - 23, box.y, 23, box.height)) = 0;
  const cv::Mat1b labels = edges(w, EDGE_OCCLUSION);
  // the shadow is seen along columns too, where it has the wall above and below
  EXPECT_EQ(cv::countNonZero(labels != outline()), 0);
}

TEST(OcclusionEdges, UnmeasuredPixelsOnTheNearSideMoveTheEdgeInwards)
{
  cv::Mat1f w = boxBeforeWall();
  w(cv::Rect(box.x, box.y, 2, box.height)) = 0; // two columns of the box are lost
  cv::Mat1b expected(480, 640, static_cast<unsigned char>(0));
  cv::rectangle(
      expected, {box.x + 2, box.y, box.width - 2, box.height}, EDGE_OCCLUSION);
  EXPECT_EQ(cv::countNonZero(edges(w, EDGE_OCCLUSION) != expected), 0);
}

TEST(OcclusionEdges, AHoleInASurfaceIsNoEdgeButAVoidIs)
{
  cv::Mat1f w = folded({640, 480}, 1.0, 0.0, 0.0, true, 1);
  w(cv::Rect(300, 200, 20, 20)) = 0;
  EXPECT_EQ(cv::countNonZero(edges(w, EDGE_OCCLUSION)), 0);
  // 200 px are more than any shadow: the surface ends there
  w(cv::Rect(300, 200, 200, 200)) = 0;
  const cv::Mat1b labels = edges(w, EDGE_OCCLUSION);
  cv::Mat1b expected(480, 640, static_cast<unsigned char>(0));
  expected(cv::Rect(300, 199, 200, 1)) = EDGE_OCCLUSION;
  expected(cv::Rect(300, 400, 200, 1)) = EDGE_OCCLUSION;
  expected(cv::Rect(299, 200, 1, 200)) = EDGE_OCCLUSION;
  expected(cv::Rect(500, 200, 1, 200)) = EDGE_OCCLUSION;
  EXPECT_EQ(cv::countNonZero(labels != expected), 0);
}

TEST(OcclusionEdges, AMixedPixelBetweenTwoSurfacesIsNone)
{
  cv::Mat1f w = boxBeforeWall();
  w(cv::Rect(box.br().x, box.y, 1, box.height)) = 1 / 1.1F; // half box, half wall
  EXPECT_EQ(cv::countNonZero(
                edges(w, EDGE_OCCLUSION)(cv::Rect(box.br().x, box.y + 1, 1, 138))),
            0);
  EXPECT_EQ(cv::countNonZero(
                edges(w, EDGE_OCCLUSION)(cv::Rect(box.br().x - 1, box.y, 1, 140))),
            140);
}

TEST(OcclusionEdges, NoneOnASteepNoisyPlane)
{
  // 75 degrees: neighbouring rows differ by 8 mm and more
  const double tilt = 75 * M_PI / 180;
  const Eigen::Vector4d floor(0, std::sin(tilt), std::cos(tilt), std::cos(tilt) * 1.2);
  const SensorModel sensor;
  const cv::Mat1f w = planes({640, 480}, {floor}, &sensor, 3);
  const cv::Mat1b labels = edges(w.rowRange(200, 480).clone(), EDGE_OCCLUSION);
  // 5 sigmas on a jump and on two predictions: one pixel in a million by chance
  EXPECT_LE(cv::countNonZero(labels), 2);
}

class RenderedBox : public ::testing::TestWithParam<unsigned> {};

// The renderer knows which thing every pixel shows.
TEST_P(RenderedBox, SilhouetteIsCompleteAndOnTheNearSide)
{
  samples::RandomBoxOptions options;
  options.on_ground = GetParam() % 2 == 0;
  options.max_distance = 2.0;
  const samples::Frame frame =
      samples::render(samples::randomBoxScene(GetParam(), options));
  cv::Mat1f w(480, 640);
  for (std::size_t i = 0; i < frame.cloud.size(); ++i) {
    const float z = frame.cloud[i].z;
    w.at<float>(static_cast<int>(i / 640), static_cast<int>(i % 640)) =
        z > 0 ? 1 / z : 0;
  }
  const cv::Mat1b labels = edges(w, EDGE_OCCLUSION);
  const SensorModel sensor;
  const std::array<cv::Point, 4> sides = {
      cv::Point(1, 0), cv::Point(-1, 0), cv::Point(0, 1), cv::Point(0, -1)};
  int wanted = 0, found = 0, wrong = 0;
  for (int v = 1; v < 479; ++v)
    for (int u = 1; u < 639; ++u) {
      if (w(v, u) <= 0)
        continue;
      bool is_near = false, is_far = false, ends = false, is_nearer = false;
      for (const auto& side : sides) {
        const cv::Point p = cv::Point(u, v) + side;
        if (w(p) <= 0) {
          ends = true;
          continue;
        }
        const double step = 1 / w(p) - 1 / w(v, u);
        // well above the detector's 5 sigmas, whatever the slope
        is_near = is_near || (frame.truth.object(p) != frame.truth.object(v, u) &&
                              step > 15 * sensor.sigmaZ(1 / w(v, u)));
        is_nearer = is_nearer ||
                    (frame.truth.object(p) != frame.truth.object(v, u) && step > 0);
        is_far = is_far || (frame.truth.object(p) != frame.truth.object(v, u) &&
                            step < -sensor.sigmaZ(1 / w(p)));
      }
      // towards the border a void is recognised from 64 px on
      ends = ends && frame.truth.object(v, u) == 0;
      const bool inside = u > 64 && v > 64 && u < 575 && v < 415;
      if ((is_near && !is_far) || (ends && inside)) {
        ++wanted;
        found += labels(v, u) != 0 ? 1 : 0;
      }
      else if (labels(v, u) != 0 && !is_nearer && !ends)
        ++wrong;
    }
  ASSERT_GT(wanted, 50);
  EXPECT_GE(found, 0.99 * wanted);
  EXPECT_LE(wrong, 0.01 * wanted);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RenderedBox, ::testing::Range(1U, 9U));

struct Fold {
  double z;
  double direction; // degrees
  cv::Size size;
};

class CreaseOfTwoPlanes : public ::testing::TestWithParam<Fold> {};

TEST_P(CreaseOfTwoPlanes, IsFoundWithinTwoPixels)
{
  const Fold& fold = GetParam();
  const double direction = fold.direction * M_PI / 180;
  const cv::Mat1f w = folded(fold.size, fold.z, 90 * M_PI / 180, direction, true, 11);
  const cv::Mat1b labels = edges(w, EDGE_CREASE);
  const Intrinsics c = camera(w.cols, w.rows);
  // one cell of the detector is this many pixels; at 640 and below the bound is 2 px
  const double tolerance = 2.0 * std::max(1.0, w.cols / 640.0);
  int off = 0, all = 0;
  const int bins =
      std::min(w.rows, w.cols) / 4; // of 2 px: at 45 degrees pixels lie 1.4 apart
  std::vector<bool> covered(static_cast<std::size_t>(bins), false);
  for (int v = 0; v < w.rows; ++v)
    for (int u = 0; u < w.cols; ++u) {
      if (labels(v, u) == 0)
        continue;
      const double du = u - c.cx, dv = v - c.cy;
      const double distance = du * std::cos(direction) + dv * std::sin(direction);
      const double along = -du * std::sin(direction) + dv * std::cos(direction);
      ++all;
      off += std::abs(distance) > tolerance ? 1 : 0;
      const int bin = static_cast<int>(std::floor(along / 2 + bins / 2.0));
      if (std::abs(distance) <= tolerance && bin >= 0 && bin < bins)
        covered[static_cast<std::size_t>(bin)] = true;
    }
  EXPECT_LE(off, 0.05 * all) << "of " << all;
  EXPECT_GE(std::count(covered.begin(), covered.end(), true), 0.9 * bins);
}

INSTANTIATE_TEST_SUITE_P(DepthsAndDirections,
                         CreaseOfTwoPlanes,
                         ::testing::Values(Fold{0.6, 0, {640, 480}},
                                           Fold{1.0, 0, {640, 480}},
                                           Fold{1.0, 30, {640, 480}},
                                           Fold{1.0, 45, {640, 480}},
                                           Fold{1.0, 90, {640, 480}},
                                           Fold{2.0, 10, {640, 480}},
                                           Fold{3.0, 70, {640, 480}},
                                           Fold{1.0, 20, {320, 240}},
                                           Fold{1.0, 20, {1280, 960}}));

// The rate that the documents state.
constexpr double false_crease_rate = 2e-4;

TEST(CreaseEdges, NearlyNoneOnNoisyPlanes)
{
  int pixels = 0, creases = 0;
  for (const double z : {0.5, 0.8, 1.5, 3.0})
    for (const double degrees : {0.0, 40.0, 65.0})
      for (unsigned seed = 0; seed < 2; ++seed) {
        const double tilt = degrees * M_PI / 180;
        const Eigen::Vector4d plane(
            0.3 * std::sin(tilt), std::sin(tilt), std::cos(tilt), std::cos(tilt) * z);
        const SensorModel sensor;
        cv::Mat1f w = planes({640, 480}, {plane}, &sensor, seed);
        w.setTo(0, w < 1 / 5.0F); // beyond the sensor's range
        creases += cv::countNonZero(edges(w, EDGE_CREASE));
        pixels += cv::countNonZero(w);
      }
  EXPECT_LE(creases, false_crease_rate * pixels) << "of " << pixels;
}

TEST(CreaseEdges, TheAngleDecides)
{
  DepthEdgeParameters parameters;
  parameters.crease_angle = 25 * M_PI / 180;
  parameters.sensor = SensorModel::constant(1e-4); // noise decides nothing
  for (const double degrees : {10.0, 20.0, 30.0, 60.0, 100.0}) {
    const cv::Mat1f w = folded({640, 480}, 1.0, degrees * M_PI / 180, 0.2, false, 0);
    const int n = cv::countNonZero(edges(w, EDGE_CREASE, parameters));
    // a crease continues below the threshold, but does not begin there
    if (degrees < 25) {
      EXPECT_EQ(n, 0) << degrees;
    }
    else {
      EXPECT_GT(n, 400) << degrees;
    }
  }
}

TEST(CreaseEdges, NoneAtASilhouette)
{
  EXPECT_EQ(cv::countNonZero(edges(boxBeforeWall(), EDGE_CREASE)), 0);
}

TEST(DepthEdgesBasics, EmptyUnmeasuredAndTinyFrames)
{
  EXPECT_TRUE(edges(cv::Mat1f(), EDGE_ALL).empty());
  EXPECT_EQ(cv::countNonZero(edges(cv::Mat1f(480, 640, 0.0F), EDGE_ALL)), 0);
  for (const cv::Size size : {cv::Size(1, 1),
                              cv::Size(1, 9),
                              cv::Size(9, 1),
                              cv::Size(12, 7),
                              cv::Size(17, 33)})
    EXPECT_EQ(cv::countNonZero(edges(cv::Mat1f(size, 1.0F), EDGE_ALL)), 0);
}

TEST(DepthEdgesBasics, BadParametersThrow)
{
  const cv::Mat1f w = boxBeforeWall();
  DepthEdgeParameters parameters;
  parameters.step_sigmas = 0;
  EXPECT_THROW(edges(w, EDGE_ALL, parameters), std::invalid_argument);
  parameters = {};
  parameters.crease_angle = 2;
  EXPECT_THROW(edges(w, EDGE_ALL, parameters), std::invalid_argument);
  parameters = {};
  parameters.crease_sigmas = NAN;
  EXPECT_THROW(edges(w, EDGE_ALL, parameters), std::invalid_argument);
  DepthEdges detector;
  cv::Mat1b labels(3, 3);
  EXPECT_THROW(detector.detect(w, camera(640, 480), {}, EDGE_ALL, labels),
               std::invalid_argument);
}

} // namespace
} // namespace hoist
