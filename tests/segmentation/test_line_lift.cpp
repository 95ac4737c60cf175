// Segments of the image lifted through the pixel index, against planes whose meeting
// line is known exactly.
#include <hoist/segmentation/line_lift.h>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace hoist {
namespace {

Intrinsics
camera()
{
  Intrinsics c;
  c.fx = c.fy = 525;
  c.cx = 319.5;
  c.cy = 239.5;
  return c;
}

// An image of points with the given depth at each pixel; <= 0 or NaN: not measured.
template <typename DepthFunction>
FrameImages
frame(const DepthFunction& depth)
{
  FrameImages images;
  images.intrinsics = camera();
  images.points.create(480, 640);
  images.inverse_depth.create(480, 640);
  for (int v = 0; v < 480; ++v)
    for (int u = 0; u < 640; ++u) {
      const double z = depth(u, v);
      const bool measured = z > 0;
      const Eigen::Vector3d p = images.intrinsics.ray(u, v) * z;
      const float nan = std::numeric_limits<float>::quiet_NaN();
      images.points(v, u) = measured ? cv::Vec3f(static_cast<float>(p.x()),
                                                 static_cast<float>(p.y()),
                                                 static_cast<float>(p.z()))
                                     : cv::Vec3f(nan, nan, nan);
      images.inverse_depth(v, u) = measured ? static_cast<float>(1 / p.z()) : 0.0F;
    }
  return images;
}

// Depth of the plane normal . p = offset on the ray of a pixel.
double
planeDepth(const Eigen::Vector3d& normal, double offset, int u, int v)
{
  return offset / normal.dot(camera().ray(u, v));
}

PixelSegment
project(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  return {{camera().project(a).cast<float>(), camera().project(b).cast<float>()}};
}

double
lineDistance(const Eigen::Vector3d& p,
             const Eigen::Vector3d& a,
             const Eigen::Vector3d& b)
{
  return (p - a).cross((b - a).normalized()).norm();
}

TEST(LiftEndpoints, TakesThePointOfThePixel)
{
  const FrameImages images =
      frame([](int u, int v) { return 1.0 + 0.001 * u + 0.002 * v; });
  LineSegment line;
  ASSERT_EQ(liftEndpoints(images, {{Eigen::Vector2f(100, 50), {300, 200}}}, 0, line),
            LiftStatus::lifted);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(line.points[0][k], images.points(50, 100)[k]);
    EXPECT_EQ(line.points[1][k], images.points(200, 300)[k]);
  }
  // Table 2: the difference of the points and its length
  EXPECT_EQ(line.delta(), line.points[1] - line.points[0]);
  EXPECT_DOUBLE_EQ(line.length(), line.delta().norm());
}

TEST(LiftEndpoints, StrictByDefaultAndSearchesWhenAsked)
{
  // no depth in a disc of 3 px around (100, 50)
  const FrameImages images = frame([](int u, int v) {
    return (u - 100) * (u - 100) + (v - 50) * (v - 50) <= 9 ? 0.0 : 1.0;
  });
  const PixelSegment segment = {{Eigen::Vector2f(100, 50), {300, 200}}};
  LineSegment line;
  EXPECT_EQ(liftEndpoints(images, segment, 0, line), LiftStatus::no_depth);
  EXPECT_EQ(liftEndpoints(images, segment, 3, line), LiftStatus::no_depth);
  EXPECT_EQ(liftEndpoints(images, segment, 4, line), LiftStatus::lifted);
}

TEST(LiftEndpoints, OfEquallyNearPixelsTheNearerPointCounts)
{
  const FrameImages images = frame([](int u, int) {
    return u == 100 ? 0.0 : u < 100 ? 2.0 : 1.0;
  });
  LineSegment line;
  ASSERT_EQ(liftEndpoints(images, {{Eigen::Vector2f(100, 50), {300, 200}}}, 1, line),
            LiftStatus::lifted);
  EXPECT_FLOAT_EQ(static_cast<float>(line.points[0].z()), 1.0F);
}

TEST(LiftEndpoints, OutsideTheImageThereIsNoDepth)
{
  const FrameImages images = frame([](int, int) { return 1.0; });
  LineSegment line;
  EXPECT_EQ(liftEndpoints(images, {{Eigen::Vector2f(-4, 50), {300, 200}}}, 0, line),
            LiftStatus::no_depth);
  EXPECT_EQ(liftEndpoints(images, {{Eigen::Vector2f(7, 7), {7, 7}}}, 0, line),
            LiftStatus::degenerate);
}

// A convex edge of two faces that meet in a known line, the image segment drawn up to a
// pixel beside it.
TEST(LiftRobust, FindsTheLineWhereTwoFacesMeet)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> angle(0.4, 1.1), shift(-1, 1);
  for (int seed = 0; seed < 30; ++seed) {
    const Eigen::Vector3d a(-0.2, -0.1, 1.2 + 0.2 * shift(random));
    const Eigen::Vector3d b(0.25, 0.15, 1.2 + 0.2 * shift(random));
    const Eigen::Vector3d along = (b - a).normalized();
    // normals towards the camera, to both sides of the edge
    Eigen::Vector3d towards = -0.5 * (a + b);
    towards = (towards - along * along.dot(towards)).normalized();
    const Eigen::Vector3d left = Eigen::AngleAxisd(angle(random), along) * towards;
    const Eigen::Vector3d right = Eigen::AngleAxisd(-angle(random), along) * towards;
    const FrameImages images = frame([&](int u, int v) {
      // a convex body: the farther of its planes bounds it
      return std::max(planeDepth(left, left.dot(a), u, v),
                      planeDepth(right, right.dot(a), u, v));
    });
    PixelSegment drawn = project(a, b);
    for (auto& p : drawn.pixels)
      p += Eigen::Vector2f(static_cast<float>(0.7 * shift(random)),
                           static_cast<float>(0.7 * shift(random)));
    LineSegment line;
    ASSERT_EQ(liftRobust(images, drawn, SensorModel::kinect(), 4, line),
              LiftStatus::lifted);
    // Across the edge nothing but rounding to pixels within one strip is left: the two
    // planes are linear in inverse depth.
    for (const auto& p : line.points)
      EXPECT_LT(lineDistance(p, a, b), 1e-4) << "seed " << seed;
    EXPECT_LT(line.direction().cross(along).norm(), 1e-3);
  }
}

TEST(LiftRobust, TakesTheNearSideOfAStep)
{
  const FrameImages images = frame([](int u, int v) {
    return u < 300 ? planeDepth({0.3, 0.1, 1}, 0.8, u, v) : 2.0;
  });
  LineSegment line;
  // as Canny would draw it: up to a pixel to either side of the step
  for (const float u : {298.5F, 299.5F, 300.5F}) {
    ASSERT_EQ(liftRobust(images,
                         {{Eigen::Vector2f(u, 100), {u, 300}}},
                         SensorModel::kinect(),
                         4,
                         line),
              LiftStatus::lifted);
    for (const auto& p : line.points)
      EXPECT_LT(std::abs(Eigen::Vector3d(0.3, 0.1, 1).dot(p) - 0.8), 1e-4) << u;
  }
}

TEST(LiftRobust, ColourEdgesOnAPlaneStayWhereTheyAre)
{
  const Eigen::Vector3d normal(0.2, -0.3, 1);
  const FrameImages images =
      frame([&](int u, int v) { return planeDepth(normal, 1, u, v); });
  const PixelSegment segment = {{Eigen::Vector2f(100.25F, 90.5F), {400.75F, 310}}};
  LineSegment line;
  ASSERT_EQ(liftRobust(images, segment, SensorModel::kinect(), 4, line),
            LiftStatus::lifted);
  EXPECT_EQ(line.pixels, segment.pixels);
  for (const auto& p : line.points)
    EXPECT_NEAR(normal.dot(p), 1, 1e-5);
  EXPECT_LT(line.sigma, 1e-5);
}

TEST(LiftRobust, OutliersAndNoiseDoNotTurnTheLine)
{
  std::mt19937 random(11);
  const SensorModel sensor = SensorModel::kinect();
  std::normal_distribution<double> noise(0, sensor.sigmaZ(1.0));
  std::uniform_real_distribution<double> chance(0, 1);
  const Eigen::Vector3d normal(0.1, -0.2, 1);
  const FrameImages images = frame([&](int u, int v) {
    // a fifth of the pixels belongs to something else
    return chance(random) < 0.2 ? 0.5 + chance(random)
                                : planeDepth(normal, 1, u, v) + noise(random);
  });
  LineSegment line;
  ASSERT_EQ(
      liftRobust(images, {{Eigen::Vector2f(150, 90), {450, 310}}}, sensor, 4, line),
      LiftStatus::lifted);
  // 8 strips of 370 pixels: the mean is known to sigma / 50, the ends to some four
  // times that; the bound leaves another factor of four
  for (const auto& p : line.points)
    EXPECT_LT(std::abs(normal.dot(p) - 1), 16 * sensor.sigmaZ(1.0) / 50);
  // the residual is the noise, up to the share that the reweighting cuts off
  EXPECT_NEAR(line.sigma / sensor.sigmaZ(1.0), 1, 0.3);
}

TEST(LiftRobust, SaysWhyNot)
{
  LineSegment line;
  const PixelSegment segment = {{Eigen::Vector2f(100, 90), {400, 310}}};
  const FrameImages nothing = frame([](int, int) { return 0.0; });
  EXPECT_EQ(liftRobust(nothing, segment, {}, 4, line), LiftStatus::no_depth);
  FrameImages blind = frame([](int, int) { return 1.0; });
  blind.intrinsics = {};
  EXPECT_EQ(liftRobust(blind, segment, {}, 4, line), LiftStatus::no_camera);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> anything(0.5, 4);
  const FrameImages chaos = frame([&](int, int) { return anything(random); });
  EXPECT_EQ(liftRobust(chaos, segment, {}, 4, line), LiftStatus::not_straight);
}

} // namespace
} // namespace hoist
