// The sample scenes: the ray caster against geometry, the committed files against it.
#include "temp_folder.h"

#include <samples/generate.h>
#include <samples/raycast.h>
#include <samples/render.h>
#include <samples/sample_files.h>

#include <hoist/data/cuboid.h>

#include <support/cuboid_compare.h>
#include <support/truth.h>

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace hoist::samples;

hoist::Cuboid
cuboidOf(const Box& box)
{
  hoist::Cuboid c;
  c.center = box.center;
  c.axes = box.axes;
  c.size = box.size;
  return c;
}

TEST(Samples, GeneratorReproducesTheCommittedFiles)
{
  const hoist::test::TempFolder folder;
  const std::filesystem::path committed = HOIST_SAMPLES_DIR;
  std::size_t files = 0, bytes = 0;
  for (const auto& path : writeSamples(folder.path())) {
    const auto relative = std::filesystem::relative(path, folder.path());
    const std::string expected = hoist::test::readFile(committed / relative);
    // EXPECT_EQ would print megabytes
    EXPECT_TRUE(hoist::test::readFile(path) == expected)
        << relative << " differs: run hoist_make_samples data/samples";
    ++files;
    bytes += expected.size();
  }
  EXPECT_GE(files, 12u);
  EXPECT_LT(bytes, 10u << 20);
}

class RandomScenes : public testing::TestWithParam<std::uint64_t> {};

TEST_P(RandomScenes, PointsLieOnTheirRayAndOnTheBox)
{
  RandomBoxOptions options;
  options.width = 160;
  options.height = 120;
  options.min_face_px = 25;
  options.max_aspect = GetParam() % 2 == 0 ? 20 : 4;
  options.on_ground = GetParam() % 3 == 0;
  const Scene scene = randomBoxScene(GetParam(), options);
  const Frame frame = render(scene);
  ASSERT_EQ(frame.cloud.width, 160u);
  const Box& box = scene.boxes.at(0);
  EXPECT_NEAR(box.axes.determinant(), 1.0, 1e-12);
  std::size_t on_box = 0;
  for (int v = 0; v < scene.height; ++v)
    for (int u = 0; u < scene.width; ++u) {
      const Eigen::Vector3d p = frame.cloud(u, v).getVector3fMap().cast<double>();
      if (frame.truth.object(v, u) < 0) {
        EXPECT_FALSE(std::isfinite(p.z()));
        continue;
      }
      // one rounding to float: the relative error is at most 2^-24 per coordinate
      const Eigen::Vector2d pixel = scene.camera.project(p);
      EXPECT_NEAR(pixel.x(), u, 1e-4);
      EXPECT_NEAR(pixel.y(), v, 1e-4);
      if (frame.truth.object(v, u) != 0)
        continue;
      ++on_box;
      const Eigen::Vector3d local = box.axes.transpose() * (p - box.center);
      const int face = frame.truth.face(v, u);
      EXPECT_NEAR(
          local[face / 2], (face % 2 == 0 ? 0.5 : -0.5) * box.size[face / 2], 1e-6);
      for (int k = 0; k < 3; ++k)
        EXPECT_LE(std::abs(local[k]), box.size[k] / 2 + 1e-6);
    }
  const BoxTruth& truth = frame.truth.boxes.at(0);
  EXPECT_EQ(truth.visible_pixels, on_box);
  EXPECT_EQ(truth.alone_pixels, on_box); // a lone box is wholly seen
  EXPECT_EQ(truth.facesVisible(), 3);
  EXPECT_FALSE(truth.touches_border);
}

TEST_P(RandomScenes, TablesAreFreeOfIntersections)
{
  RandomTableOptions options;
  options.width = 160;
  options.height = 120;
  const Scene scene = randomTableScene(GetParam(), 6, options);
  EXPECT_GE(scene.boxes.size(), 3u);
  const Patch& table = scene.patches.at(0);
  for (std::size_t i = 0; i < scene.boxes.size(); ++i) {
    // all corners on the table's side, at or above it
    const auto corners = cuboidOf(scene.boxes[i]).corners();
    double lowest = 1;
    for (int k = 0; k < 8; ++k)
      lowest = std::min(lowest, table.axes.col(2).dot(corners.col(k) - table.center));
    EXPECT_GE(lowest, -1e-9);
    for (std::size_t k = 0; k < i; ++k)
      EXPECT_LT(hoist::test::intersectionVolume(cuboidOf(scene.boxes[i]),
                                                cuboidOf(scene.boxes[k])),
                1e-12);
  }
}

TEST_P(RandomScenes, SameSeedSameBytes)
{
  RandomTableOptions options;
  options.width = 80;
  options.height = 60;
  const Frame a = render(randomTableScene(GetParam(), 4, options));
  const Frame b = render(randomTableScene(GetParam(), 4, options));
  const Frame c = render(randomTableScene(GetParam() + 1, 4, options));
  const auto bytes = [](const Frame& f) {
    std::string out;
    for (const auto& p : f.cloud) {
      out.append(reinterpret_cast<const char*>(p.data), 12);
      out.append(reinterpret_cast<const char*>(&p.rgba), 4);
    }
    return out;
  };
  EXPECT_TRUE(bytes(a) == bytes(b));
  EXPECT_FALSE(bytes(a) == bytes(c));
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomScenes, testing::Range<std::uint64_t>(1, 13));

TEST(Render, NoiseFollowsTheSensorModel)
{
  // A wall at 2 m: the spread of the measured depth is the model's sigma together with
  // the disparity's step, whose own spread is step / sqrt(12).
  Scene scene;
  Patch wall;
  wall.center = {0, 0, 2};
  scene.patches.push_back(wall);
  scene.width = 320;
  scene.height = 240;
  scene.supersampling = 1;
  scene.noise = Noise::kinect();
  const Frame frame = render(scene);
  double sum = 0, squares = 0;
  std::size_t n = 0;
  for (const auto& p : frame.cloud)
    if (std::isfinite(p.z)) {
      sum += p.z - 2.0;
      squares += (p.z - 2.0) * (p.z - 2.0);
      ++n;
    }
  const double sigma = scene.noise.sensor.sigmaZ(2.0);
  const double step = 2.0 * 2.0 / (580 * 0.075) * 0.125;
  const double expected = std::hypot(sigma, step / std::sqrt(12.0));
  EXPECT_GT(n, frame.cloud.size() * 9 / 10);
  EXPECT_NEAR(std::sqrt(squares / n), expected, 0.1 * expected);
  EXPECT_NEAR(sum / n, 0.0, 0.2 * sigma);
}

TEST(Render, SecondEyeCastsAShadowWithoutDepth)
{
  // A box before a wall: seen from an eye on the right, the wall beside the box's left
  // edge is hidden, over a band of b * (wall - box) / box metres.
  Scene scene;
  Patch wall;
  wall.center = {0, 0, 2};
  scene.patches.push_back(wall);
  Box box;
  box.center = {0, 0, 1.05};
  box.size = {0.3, 0.3, 0.1};
  scene.boxes.push_back(box);
  scene.supersampling = 1;
  scene.noise = Noise::kinect();
  scene.noise.dropout = 0;
  scene.noise.lateral_sigma = 0;
  const Frame frame = render(scene);
  const int row = 239;
  int left = 0, right = 0;
  for (int u = 0; u < 640; ++u)
    if (!std::isfinite(frame.cloud(u, row).z))
      ++(u < 320 ? left : right);
  // The edge at (-0.15, z = 1) throws the light's ray to x = -0.15 - (0.225)/1 * 1 =
  // -0.375 at the wall: pixel 221.06. The box's own edge is at pixel 240.75.
  EXPECT_EQ(left, 19);
  EXPECT_EQ(right, 0);
}

TEST(Render, ShadowsAndIlluminantColorThePicture)
{
  const Scene scene = sampleScenes().at(0);
  Scene bright = scene, tinted = scene;
  bright.shadows = false;
  tinted.illuminant = {1, 0.5, 0.25};
  const Frame a = render(scene), b = render(bright), c = render(tinted);
  std::size_t darker = 0;
  double red = 0, blue = 0;
  for (std::size_t i = 0; i < a.cloud.size(); ++i) {
    darker += a.cloud[i].g + 20 < b.cloud[i].g ? 1 : 0;
    if (a.truth.object(static_cast<int>(i) / 640, static_cast<int>(i) % 640) >= 0) {
      red += c.cloud[i].r - a.cloud[i].r;
      blue += c.cloud[i].b - 0.25 * a.cloud[i].b;
    }
  }
  EXPECT_GT(darker, 1000u);
  EXPECT_NEAR(red / a.cloud.size(), 0.0, 0.5);
  EXPECT_NEAR(blue / a.cloud.size(), 0.0, 0.6);
}

TEST(Truth, FilesHoldWhatWasRendered)
{
  const std::filesystem::path folder = HOIST_SAMPLES_DIR;
  for (const Scene& scene : sampleScenes()) {
    const auto truth =
        hoist::test::loadTruth(folder / "truth" / (scene.name + ".json"));
    EXPECT_EQ(truth.scene, scene.name);
    EXPECT_EQ(truth.intrinsics.fx, scene.camera.fx);
    ASSERT_EQ(truth.cuboids.size(), scene.boxes.size());
    for (std::size_t i = 0; i < scene.boxes.size(); ++i) {
      EXPECT_EQ(truth.cuboids[i].cuboid.center, scene.boxes[i].center);
      EXPECT_EQ(truth.cuboids[i].cuboid.axes, scene.boxes[i].axes);
      EXPECT_EQ(truth.cuboids[i].cuboid.size, scene.boxes[i].size);
      EXPECT_GT(truth.cuboids[i].visible_fraction, 0.0);
    }
  }
}

} // namespace
