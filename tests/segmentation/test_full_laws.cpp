// What must hold for the full mode whatever the scene: the answer moves with it, and
// the same frame gives the same bytes.
#include "test_full_frames.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <map>
#include <string>

namespace hoist {
namespace {

samples::RandomBoxOptions
boxes(bool on_ground)
{
  samples::RandomBoxOptions options;
  options.on_ground = on_ground;
  options.min_face_px = 1500;
  options.max_distance = 2;
  return options;
}

// Distances from the camera times s: the same image.
FrameImages
scaled(const FrameImages& images, double s)
{
  FrameImages out;
  out.intrinsics = images.intrinsics;
  out.points = images.points.clone();
  for (auto& p : out.points)
    p *= static_cast<float>(s);
  out.inverse_depth = images.inverse_depth / static_cast<float>(s);
  return out;
}

TEST(FullModeLaws, ScalingTheSceneScalesTheAnswer)
{
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const samples::Scene scene = samples::randomBoxScene(seed, boxes(seed % 2 == 0));
    const FrameImages images = test::exactFrame(scene).images;
    FullModeParameters parameters;
    parameters.sensor = SensorModel::constant(0.002);
    const auto one = test::segment(images, parameters);
    ASSERT_EQ(one.size(), 1U) << "seed " << seed;
    for (const double s : {0.5, 1.7, 3.0}) {
      FullModeParameters large = parameters;
      large.sensor.sigma_constant *= s;
      large.min_side *= s;
      large.max_side *= s;
      const auto other = test::segment(scaled(images, s), large);
      ASSERT_EQ(other.size(), 1U) << "seed " << seed << " scale " << s;
      Cuboid expected = one[0];
      expected.center *= s;
      expected.size *= s;
      const auto e = test::compare(other[0], expected);
      // the same image: only the rounding of floats and of the table of sigmas differs
      EXPECT_LT(e.center / s, 1e-5);
      EXPECT_LT(e.maxSize() / s, 1e-5);
      EXPECT_LT(e.rotation, 1e-4 * test::degree);
      EXPECT_NEAR(other[0].score, one[0].score, 1e-6);
    }
  }
}

// The camera turned by a quarter about its axis: u' = v, v' = width - 1 - u.
FrameImages
rolled(const FrameImages& images)
{
  FrameImages out;
  const Intrinsics& k = images.intrinsics;
  out.intrinsics = k;
  out.intrinsics.fx = k.fy;
  out.intrinsics.fy = k.fx;
  out.intrinsics.cx = k.cy;
  out.intrinsics.cy = images.width() - 1 - k.cx;
  out.points.create(images.width(), images.height());
  out.inverse_depth.create(images.width(), images.height());
  for (int v = 0; v < images.height(); ++v)
    for (int u = 0; u < images.width(); ++u) {
      const cv::Vec3f p = images.points(v, u);
      out.points(images.width() - 1 - u, v) = {p[1], -p[0], p[2]};
      out.inverse_depth(images.width() - 1 - u, v) = images.inverse_depth(v, u);
    }
  return out;
}

TEST(FullModeLaws, RollingTheCameraRollsTheAnswer)
{
  Eigen::Matrix3d turn;
  turn << 0, 1, 0, -1, 0, 0, 0, 0, 1;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const samples::Scene scene = samples::randomBoxScene(seed, boxes(seed % 2 == 0));
    const FrameImages images = test::exactFrame(scene).images;
    const auto one = test::segment(images), other = test::segment(rolled(images));
    ASSERT_EQ(one.size(), 1U) << "seed " << seed;
    ASSERT_EQ(other.size(), 1U) << "seed " << seed;
    Cuboid expected = one[0];
    expected.center = turn * expected.center;
    expected.axes = turn * expected.axes;
    const auto e = test::compare(other[0], expected);
    // steps along the outline fall on the other sides of the pixels: a tenth of a
    // millimetre is a twentieth of a pixel here
    EXPECT_LT(e.center, 1e-4);
    EXPECT_LT(e.maxSize(), 1e-4);
    EXPECT_LT(e.rotation, 1e-3 * test::degree);
  }
}

TEST(FullModeLaws, NoiseFlipsNoAxesAndSpreadsNoMoreThanSigmaSays)
{
  // measured: 0.9, 0.9, 0.6 sigma
  using Sums = std::array<double, 2>; // squares: of the spread, of sigma
  Sums center{}, size{}, turn{};
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    samples::Scene scene = samples::randomBoxScene(seed, boxes(true));
    scene.noise = samples::Noise::kinect();
    std::vector<Cuboid> found;
    for (std::uint64_t noise = 1; noise <= 10; ++noise) {
      scene.seed = noise;
      FrameImages images;
      test::renderedFrame(scene, images);
      const auto cuboids = test::segment(images);
      ASSERT_EQ(cuboids.size(), 1U) << "seed " << seed << " noise " << noise;
      found.push_back(cuboids[0]);
    }
    Eigen::Vector3d mean = Eigen::Vector3d::Zero(), mean_size = mean;
    for (const Cuboid& c : found) {
      mean += c.center / found.size();
      mean_size += c.size / found.size();
    }
    const double n = static_cast<double>(found.size());
    for (const Cuboid& c : found) {
      const double angle =
          Eigen::AngleAxisd(Eigen::Matrix3d(found[0].axes.transpose() * c.axes))
              .angle();
      EXPECT_LT(angle, 1 * test::degree) << "seed " << seed;
      center[0] += (c.center - mean).squaredNorm() / (n - 1);
      center[1] += c.center_sigma.squaredNorm() / n;
      size[0] += (c.size - mean_size).squaredNorm() / (n - 1);
      size[1] += c.size_sigma.squaredNorm() / n;
      // two of them differ by twice the variance
      turn[0] += angle * angle / 2 / (n - 1);
      turn[1] += c.rotation_sigma * c.rotation_sigma / n;
    }
  }
  for (const Sums& s : {center, size, turn})
    EXPECT_LT(std::sqrt(s[0] / s[1]), 2);
}

void
expectSameBytes(const std::vector<Cuboid>& a, const std::vector<Cuboid>& b)
{
  const auto same = [](const auto& x, const auto& y) {
    return std::memcmp(x.data(), y.data(), sizeof(x[0]) * x.size()) == 0;
  };
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_TRUE(same(a[i].center, b[i].center));
    EXPECT_TRUE(same(a[i].axes, b[i].axes));
    EXPECT_TRUE(same(a[i].size, b[i].size));
    EXPECT_TRUE(same(a[i].center_sigma, b[i].center_sigma));
    EXPECT_TRUE(same(a[i].size_sigma, b[i].size_sigma));
    EXPECT_EQ(a[i].score, b[i].score);
    EXPECT_EQ(a[i].observed_faces, b[i].observed_faces);
    EXPECT_EQ(a[i].dimension_source, b[i].dimension_source);
    EXPECT_EQ(a[i].indices, b[i].indices);
  }
}

TEST(FullModeLaws, SameFrameSameBytesWhateverCameBefore)
{
  samples::RandomTableOptions options;
  FrameImages table, small;
  test::renderedFrame(samples::randomTableScene(3, 6, options), table);
  options.width = 320;
  options.height = 240;
  test::renderedFrame(samples::randomTableScene(4, 6, options), small);
  const auto fresh = test::segment(table), again = test::segment(table);
  ASSERT_GE(fresh.size(), 3U);
  expectSameBytes(fresh, again);

  FullMode mode;
  std::vector<Cuboid> cuboids;
  Diagnostics first, second;
  ASSERT_TRUE(mode.segment(table, {}, {}, cuboids, first));
  expectSameBytes(cuboids, fresh);
  Diagnostics between;
  ASSERT_TRUE(mode.segment(small, {}, {}, cuboids, between));
  expectSameBytes(cuboids, test::segment(small));
  ASSERT_TRUE(mode.segment(table, {}, {}, cuboids, second));
  expectSameBytes(cuboids, fresh);
  EXPECT_EQ(first.counts.entries(), second.counts.entries());
  EXPECT_EQ(first.rejected.entries(), second.rejected.entries());
}

TEST(FullModeLaws, ReportedCuboidsKeepTheirContract)
{
  samples::RandomTableOptions options;
  options.cylinders = 2;
  for (std::uint64_t seed = 21; seed <= 24; ++seed) {
    FrameImages images;
    test::renderedFrame(samples::randomTableScene(seed, 7, options), images);
    const auto found = test::segment(images);
    double last = 1;
    for (const Cuboid& c : found) {
      EXPECT_LT((c.axes.transpose() * c.axes - Eigen::Matrix3d::Identity()).norm(),
                1e-12);
      EXPECT_GT(c.axes.determinant(), 0);
      EXPECT_GE(c.size.minCoeff(), FullModeParameters{}.min_side * 0.9);
      EXPECT_LE(c.score, last); // best first
      EXPECT_GE(c.score, FullModeParameters{}.min_score);
      last = c.score;
      EXPECT_TRUE(std::is_sorted(c.indices.begin(), c.indices.end()));
      const Eigen::Vector3d half = c.size / 2;
      int far = 0;
      for (const int index : c.indices) {
        const cv::Vec3f p =
            images.points(index / images.width(), index % images.width());
        const Eigen::Vector3d x =
            c.axes.transpose() * (Eigen::Vector3d(p[0], p[1], p[2]) - c.center);
        const double outside = (x.cwiseAbs() - half).maxCoeff();
        far += std::abs(outside) > 0.02 ? 1 : 0;
      }
      EXPECT_LT(far, 0.02 * c.indices.size()); // supporting pixels lie on the surface
      for (int i = 0; i < 3; ++i)
        if (c.dimension_source[i] == DimensionSource::partial) {
          EXPECT_TRUE(std::isnan(c.size_sigma[i]));
        }
    }
  }
}

TEST(FullModeLaws, EveryHypothesisHasAVerdict)
{
  samples::RandomTableOptions options;
  options.cylinders = 1;
  for (std::uint64_t seed = 31; seed <= 33; ++seed) {
    FrameImages images;
    test::renderedFrame(samples::randomTableScene(seed, 6, options), images);
    FullMode mode;
    FullModeParameters parameters;
    parameters.max_cuboids = 2;
    std::vector<Cuboid> cuboids;
    Diagnostics diagnostics;
    ASSERT_TRUE(mode.segment(images, {}, parameters, cuboids, diagnostics));
    ASSERT_EQ(cuboids.size(), 2U);
    const std::vector<CuboidVerdict> verdicts = mode.verdicts(images);
    EXPECT_EQ(verdicts.size(), diagnostics.counts["hypotheses"]);
    std::map<std::string, std::size_t> reasons;
    for (const CuboidVerdict& verdict : verdicts) {
      ++reasons[verdict.rejected];
      EXPECT_GT(verdict.cuboid.size.minCoeff(), 0);
    }
    EXPECT_EQ(reasons[""], cuboids.size());
    EXPECT_EQ(reasons["more than the maximum number"],
              diagnostics.rejected["more than the maximum number"]);
    for (const auto& [name, count] : diagnostics.rejected.entries())
      if (std::string(name) != "faces do not meet") { // no hypothesis came of those
        EXPECT_EQ(reasons[name], count) << name;
      }
    // the reported ones come first, also where their middle is seen
    for (std::size_t i = 0; i < cuboids.size(); ++i)
      EXPECT_EQ(verdicts[i].rejected, "");
    const Eigen::Vector2d p = images.intrinsics.project(cuboids[0].center);
    const auto there = mode.verdictsAt(
        images, static_cast<int>(p.x() + 0.5), static_cast<int>(p.y() + 0.5));
    ASSERT_FALSE(there.empty());
    EXPECT_EQ(there[0].rejected, "");
    EXPECT_EQ(there[0].cuboid.center, cuboids[0].center);
    EXPECT_EQ(mode.faceAt(-5, 3), nullptr);
  }
}

TEST(FullModeLaws, ParametersDoWhatTheySay)
{
  samples::RandomTableOptions options;
  FrameImages images;
  test::renderedFrame(samples::randomTableScene(3, 6, options), images);
  const auto all = test::segment(images);
  ASSERT_GE(all.size(), 3U);
  FullModeParameters best;
  best.max_cuboids = 2;
  const auto two = test::segment(images, best);
  expectSameBytes(two, {all[0], all[1]});

  FullModeParameters strict;
  strict.min_score = all[1].score;
  for (const Cuboid& c : test::segment(images, strict))
    EXPECT_GE(c.score, all[1].score);

  FullModeParameters none;
  none.min_side = 1;
  std::vector<Cuboid> cuboids = all;
  Diagnostics diagnostics;
  FullMode mode;
  EXPECT_TRUE(mode.segment(images, {}, none, cuboids, diagnostics));
  EXPECT_TRUE(cuboids.empty());
  EXPECT_GT(diagnostics.rejected["side length outside the limits"], 0U);
  EXPECT_EQ(diagnostics.counts["cuboids"], 0U);
}

TEST(FullModeLaws, AMaskKeepsTheRestOut)
{
  samples::RandomTableOptions options;
  FrameImages images;
  test::renderedFrame(samples::randomTableScene(3, 6, options), images);
  const auto all = test::segment(images);
  ASSERT_FALSE(all.empty());
  // a detector's box around the first one
  const auto corners = all[0].corners();
  int u0 = images.width(), u1 = 0, v0 = images.height(), v1 = 0;
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector2d q = images.intrinsics.project(corners.col(k));
    u0 = std::min(u0, static_cast<int>(q.x()) - 15);
    u1 = std::max(u1, static_cast<int>(q.x()) + 15);
    v0 = std::min(v0, static_cast<int>(q.y()) - 15);
    v1 = std::max(v1, static_cast<int>(q.y()) + 15);
  }
  const cv::Rect box = cv::Rect(u0, v0, u1 - u0, v1 - v0) &
                       cv::Rect(0, 0, images.width(), images.height());
  cv::Mat1b mask(images.height(), images.width(), static_cast<unsigned char>(0));
  mask(box).setTo(255);
  const auto inside = test::segment(images, {}, mask);
  ASSERT_FALSE(inside.empty());
  double best = 0;
  for (const Cuboid& c : inside)
    best = std::max(best, test::iou(c, all[0]));
  EXPECT_GT(best, 0.8);
  mask.setTo(0);
  EXPECT_TRUE(test::segment(images, {}, mask).empty());
}

TEST(FullModeLaws, WithoutACameraThereIsNoAnswer)
{
  FrameImages images;
  images.points.create(48, 64);
  images.points.setTo(cv::Scalar::all(std::numeric_limits<double>::quiet_NaN()));
  images.inverse_depth = cv::Mat1f(48, 64, 0.0F);
  FullMode mode;
  std::vector<Cuboid> cuboids(3);
  Diagnostics diagnostics;
  EXPECT_FALSE(mode.segment(images, {}, {}, cuboids, diagnostics));
  EXPECT_TRUE(cuboids.empty());
  images.intrinsics = samples::Scene::kinectCamera();
  cuboids.resize(3);
  EXPECT_TRUE(mode.segment(images, {}, {}, cuboids, diagnostics));
  EXPECT_TRUE(cuboids.empty());
}

} // namespace
} // namespace hoist
