// The parts of the viewer that need no window.
#include "failures.h"
#include "viewer/camera_file.h"
#include "viewer/detections.h"
#include "viewer/hidden_edges.h"
#include "viewer/keys.h"
#include "viewer/live_settings.h"
#include "viewer/pick.h"
#include "viewer/scene_loader.h"
#include "yaml_settings.h"

#include "data/temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <string>
#include <thread>

namespace hoist {
namespace {

using test::TempFolder;

TEST(CameraFile, ComesBackBitForBit)
{
  ViewCamera camera;
  camera.clip = {0.0123456789, 1.0 / 3};
  camera.focal = {0.1, -2e-17, 3};
  camera.position = {1e5, M_PI, -M_E};
  camera.up = {0, -1, 1e-3};
  camera.angle = 0.7;
  camera.window = {1600, 720};
  camera.corner = {-5, 3};
  const TempFolder folder;
  const ViewCamera back = readCameraFile(folder.write("a.cam", cameraText(camera)));
  EXPECT_EQ(back.clip, camera.clip);
  EXPECT_EQ(back.focal, camera.focal);
  EXPECT_EQ(back.position, camera.position);
  EXPECT_EQ(back.up, camera.up);
  EXPECT_EQ(back.angle, camera.angle);
  EXPECT_EQ(back.window, camera.window);
  EXPECT_EQ(back.corner, camera.corner);
}

TEST(CameraFile, RefusesWhatIsNone)
{
  const TempFolder folder;
  for (const char* text : {"",
                           "1,2",
                           "0.1,9/0,0,1/0,0,0/0,-1,0/0.7/1,1",
                           "0.1,9/0,0,x/0,0,0/0,-1,0/0.7/1,1/0,0",
                           "0.1,9/0,0,nan/0,0,0/0,-1,0/0.7/1,1/0,0",
                           "0.1,9/0,0,0/0,0,0/0,-1,0/0.7/1,1/0,0",   // looks nowhere
                           "0.1,9/0,0,1/0,0,0/0,0,2/0.7/1,1/0,0",    // up is forward
                           "0.1,9/0,0,1/0,0,0/0,-1,0/-0.7/1,1/0,0"}) // sees nothing
    EXPECT_THROW(readCameraFile(folder.write("bad.cam", text)), FileError) << text;
}

TEST(Detections, ReadsBothLayoutsAndRefusesOthers)
{
  const TempFolder folder;
  const auto plain = loadDetections(
      folder.write("a.json", R"([{"box": [1, 2, 3, 4], "class": "cone"}])"));
  ASSERT_EQ(plain.size(), 1U);
  EXPECT_EQ(plain[0].box, cv::Rect2d(1, 2, 3, 4));
  EXPECT_EQ(plain[0].label, "cone");
  EXPECT_TRUE(std::isnan(plain[0].score));
  const auto object = loadDetections(folder.write(
      "b.json",
      R"({"detections": [{"box": [1, 2, 3, 4], "label": 7, "score": 0.5}]})"));
  ASSERT_EQ(object.size(), 1U);
  EXPECT_EQ(object[0].label, "7");
  EXPECT_EQ(object[0].score, 0.5);
  for (const char* text : {"",
                           "3",
                           "{}",
                           "[3]",
                           R"([{"box": [1, 2, 3]}])",
                           R"([{"box": [1, 2, 0, 4]}])",
                           R"([{"box": [1, 2, 1e300, 4]}])",
                           R"([{"box": ["a", 2, 3, 4]}])"})
    EXPECT_THROW(loadDetections(folder.write("bad.json", text)), FileError) << text;
  EXPECT_THROW(loadDetections("no/such/file.json"), FileError);
}

// A wall at 2 m with a box's front at 1 m in the middle.
FrameImages
twoSurfaces()
{
  FrameImages images;
  images.intrinsics.fx = images.intrinsics.fy = 100;
  images.intrinsics.cx = 49.5;
  images.intrinsics.cy = 39.5;
  images.points.create(80, 100);
  images.inverse_depth.create(80, 100);
  for (int v = 0; v < 80; ++v)
    for (int u = 0; u < 100; ++u) {
      const bool front = std::abs(u - 50) < 10 && std::abs(v - 40) < 10;
      const double z = front ? 1.0 : 2.0;
      const Eigen::Vector3d p = z * images.intrinsics.ray(u, v);
      images.points(v, u) = cv::Vec3f(
          static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(z));
      images.inverse_depth(v, u) = static_cast<float>(1 / z);
    }
  return images;
}

TEST(Pick, FromTheSensorEveryPixelPicksItself)
{
  const FrameImages images = twoSurfaces();
  for (int v = 0; v < 80; v += 3)
    for (int u = 0; u < 100; u += 3) {
      const SightLine line{Eigen::Vector3d::Zero(),
                           images.intrinsics.ray(u, v).normalized(),
                           0.004}; // less than half a pixel: nothing else is met
      EXPECT_EQ(pickPoint(images, line), v * 100 + u);
    }
}

TEST(Pick, WhatLiesBehindIsNotPicked)
{
  const FrameImages images = twoSurfaces();
  // beside the front's last pixel, with a reach that also meets the wall behind
  SightLine line{
      Eigen::Vector3d::Zero(), images.intrinsics.ray(59.6, 40).normalized(), 0.03};
  EXPECT_EQ(pickPoint(images, line), 40 * 100 + 59);
  line.way = -line.way;
  EXPECT_EQ(pickPoint(images, line), -1);
}

TEST(Pick, TheNearerCuboidIsPicked)
{
  Cuboid near, far;
  near.size = far.size = {0.2, 0.2, 0.2};
  near.center = {0, 0, 1};
  far.center = {0.05, 0, 2};
  const Eigen::Vector3d ahead = Eigen::Vector3d::UnitZ();
  double distance = 0;
  EXPECT_EQ(pickCuboid({far, near}, {{0, 0, 0}, ahead, 0}, &distance), 1);
  EXPECT_NEAR(distance, 0.9, 1e-12);
  EXPECT_EQ(pickCuboid({far, near}, {{0.12, 0, 0}, ahead, 0}), 0);
  EXPECT_EQ(pickCuboid({far, near}, {{0.5, 0, 0}, ahead, 0}), -1);
  EXPECT_EQ(pickCuboid({far, near}, {{0, 0, 3}, ahead, 0}), -1);
}

TEST(Keys, NoneOfPclViewerIsTaken)
{
  for (const char* key : {"p", "w", "s", "j", "c", "f", "e", "q", "g",    "u",    "o",
                          "r", "l", "x", "0", "1", "9", "P", "Q", "plus", "minus"})
    EXPECT_FALSE(actionOf(key, false, false).has_value()) << key;
  EXPECT_FALSE(actionOf("0", false, true).has_value());
  EXPECT_EQ(actionOf("n", false, false), KeyAction::next);
  EXPECT_EQ(actionOf("N", false, false), KeyAction::next);
  EXPECT_FALSE(actionOf("n", true, false).has_value());
  EXPECT_EQ(actionOf("s", true, false), KeyAction::save_camera);
}

TEST(Keys, EveryLayerHasItsOwn)
{
  std::map<std::string, int> seen;
  for (const LayerInfo& info : layerTable()) {
    EXPECT_EQ(layerOf(info.key), info.layer);
    EXPECT_EQ(infoOf(info.layer).text, info.text);
    EXPECT_EQ(++seen[info.key], 1);
    EXPECT_FALSE(actionOf(info.key, false, false).has_value());
  }
  EXPECT_FALSE(layerOf("F13").has_value());
}

struct Options {
  CLI::App command;
  RecognizeSettings settings;
  Options() { addMethodOptions(command, settings); }
};

TEST(LiveSettings, YamlGivesTheSameSettingsBack)
{
  Options first;
  first.command.parse("--keep-texture --roi=1,2,30,40 --sensor=constant:0.003 "
                      "--material=concrete --min-score=0.25");
  LiveSettings live(first.command, first.settings);
  live.choose(1);
  ASSERT_EQ(live.chosen().substr(0, 8), "min-side");
  ASSERT_TRUE(live.step(1));
  live.toggleMode();
  ASSERT_TRUE(live.step(-1));

  const TempFolder folder;
  Options second;
  second.command.parse("");
  applyYaml(second.command, folder.write("s.yaml", live.yaml()));
  const LiveSettings back(second.command, second.settings);
  EXPECT_EQ(second.settings.mode, "paper");
  EXPECT_EQ(second.settings.region, cv::Rect(1, 2, 30, 40));
  EXPECT_EQ(second.settings.material, "concrete");
  EXPECT_FALSE(second.settings.paper.canny.remove_texture);
  EXPECT_EQ(second.settings.full.min_score, 0.25);
  EXPECT_EQ(second.settings.full.min_side, first.settings.full.min_side);
  EXPECT_NE(second.settings.full.min_side, RecognizeSettings().full.min_side);
  EXPECT_EQ(second.settings.paper.distance_threshold,
            first.settings.paper.distance_threshold);
  EXPECT_EQ(back.yaml(), live.yaml()); // and nothing else differs
}

TEST(LiveSettings, StepsStayInTheRangeAndReset)
{
  for (const char* start : {"", "--mode=paper"}) {
    Options options;
    options.command.parse(start);
    LiveSettings live(options.command, options.settings);
    const std::string before = live.yaml();
    const std::string first = live.chosen().substr(0, live.chosen().find(' '));
    do {
      for (const int by : {1, -1}) {
        int steps = 0;
        while (live.step(by) && steps < 2000)
          ++steps;
        EXPECT_LT(steps, 2000) << live.chosen();
        EXPECT_FALSE(live.step(by)) << live.chosen();
        EXPECT_NO_THROW(checkMethod(options.settings));
      }
      live.choose(1);
    } while (live.chosen().rfind(first + " ", 0) != 0);
    EXPECT_NE(live.yaml(), before);
    live.reset();
    EXPECT_EQ(live.yaml(), before);
    EXPECT_EQ(options.settings.full.min_side, RecognizeSettings().full.min_side);
  }
}

Scene::ConstPtr
waitFor(const SceneLoader& loader)
{
  Scene::ConstPtr scene;
  while (!(scene = loader.wanted())) // the test's own limit ends a hang
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return scene;
}

TEST(SceneLoader, BadFilesAreScenesThatSayWhy)
{
  const TempFolder folder;
  const std::vector<std::string> files = {folder.write("a.pcd", "no cloud"),
                                          folder.write("b.pcd", ""),
                                          folder.name("none.pcd")};
  SceneLoader loader(files, {}, {});
  for (std::size_t i = 0; i < files.size(); ++i) {
    loader.want(i);
    const Scene::ConstPtr scene = waitFor(loader);
    EXPECT_EQ(scene->file, files[i]);
    EXPECT_FALSE(scene->hasFrame());
    EXPECT_NE(scene->error.find(files[i]), std::string::npos) << scene->error;
  }
  RecognizeSettings paper;
  paper.mode = "paper";
  loader.setSettings(paper);
  EXPECT_FALSE(waitFor(loader)->error.empty());
}

// Brute force: a point of an edge is hidden if the way to it passes through the box.
TEST(HiddenEdges, AreThoseBehindTheBox)
{
  Cuboid box;
  box.center = {0.1, -0.2, 1.5};
  box.size = {0.5, 0.3, 0.2};
  box.axes = (Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()))
                 .toRotationMatrix();
  const Eigen::Matrix<double, 3, 8> corners = box.corners();
  const auto hides = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    for (int i = 1; i < 4000; ++i) {
      const Eigen::Vector3d p = from + i / 4000.0 * (to - from);
      const Eigen::Vector3d local = box.axes.transpose() * (p - box.center);
      // a little inside: the line's own end lies on the box
      if (((2 * local).cwiseAbs().array() < (box.size.array() - 1e-3)).all())
        return true;
    }
    return false;
  };
  int most = 0;
  for (int k = 0; k < 60; ++k) {
    const Eigen::Vector3d eye =
        box.center + 1.5 * Eigen::Vector3d(std::sin(1.0 * k),
                                           std::cos(2.3 * k),
                                           std::sin(0.7 * k + 1));
    const int hidden = hiddenEdges(corners, eye, false);
    int bit = 1, count = 0;
    for (const auto& edge : Cuboid::edges()) {
      const Eigen::Vector3d middle =
          0.5 * (corners.col(edge[0]) + corners.col(edge[1]));
      EXPECT_EQ((hidden & bit) != 0, hides(eye, middle)) << "eye " << eye.transpose();
      count += (hidden & bit) != 0 ? 1 : 0;
      bit <<= 1;
    }
    most = std::max(most, count);
    // from very far away the ways are parallel
    const Eigen::Vector3d towards = (eye - box.center).normalized();
    EXPECT_EQ(hiddenEdges(corners, towards, true),
              hiddenEdges(corners, box.center + 1e6 * towards, false));
  }
  EXPECT_GT(most, 2);
  EXPECT_EQ(hiddenEdges(corners, box.center, false), 0);
}

// What both threads touch while a frame is recognised again: under ThreadSanitizer.
TEST(SceneLoader, AFrameIsSharedAndStaysAsItIs)
{
  const std::string file = std::string(HOIST_SAMPLES_DIR) + "/scenes/slab.pcd";
  SceneLoader loader({file, file, file}, {}, {});
  const Scene::ConstPtr first = waitFor(loader);
  ASSERT_TRUE(first->hasFrame()) << first->error;
  const cv::Mat1f before = first->frame->images->inverse_depth.clone();
  RecognizeSettings settings;
  settings.full.min_score = 1;
  loader.setSettings(settings);
  double sum = 0;
  Scene::ConstPtr second;
  do {
    for (const float w : first->frame->images->inverse_depth)
      sum += w;
  } while (!(second = loader.wanted()));
  EXPECT_GT(sum, 0);
  EXPECT_EQ(second->frame, first->frame); // not loaded again
  EXPECT_NE(second, first);
  EXPECT_FALSE(first->result.cuboids.empty()); // a scene that is held does not change
  EXPECT_TRUE(second->result.cuboids.empty());
  EXPECT_EQ(cv::norm(before, first->frame->images->inverse_depth, cv::NORM_INF), 0);
}

TEST(SceneLoader, StopsAndThenBeginsNothing)
{
  const std::string file = std::string(HOIST_SAMPLES_DIR) + "/scenes/slab.pcd";
  SceneLoader loader({file, file, file, file, file, file}, {}, {});
  waitFor(loader);
  EXPECT_TRUE(loader.stop(std::chrono::hours(1)));
  loader.want(5);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(loader.wanted(), nullptr);
}

} // namespace
} // namespace hoist
