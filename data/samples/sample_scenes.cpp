#include "generate.h"

namespace hoist {
namespace samples {
namespace {

const Rgb cardboard = {{190, 150, 105}};
const Rgb grey = {{150, 148, 143}};
const Rgb timber = {{185, 140, 85}};

Scene
kinectScene(const char* name, std::uint64_t seed, const View& view)
{
  Scene scene;
  scene.name = name;
  scene.seed = seed;
  scene.noise = Noise::kinect();
  scene.has_support = true;
  scene.pose = view.sensor_to_world;
  return scene;
}

Scene
stereoScene(const char* name, std::uint64_t seed, const View& view)
{
  Scene scene = kinectScene(name, seed, view);
  scene.width = 320;
  scene.height = 240;
  scene.camera = Scene::bumblebeeCamera();
  scene.noise = Noise::stereo(scene.camera.fx * 0.12, 0.12, 0.06);
  return scene;
}

// Two printed cartons on a table.
Scene
cartons()
{
  const View view = View::lookAt({0.1, -0.75, 0.72}, {0, 0.02, 0.05});
  Scene scene = kinectScene("cartons", 11, view);
  scene.patches.push_back(view.ground({0.42, 0.3}, Texture::plain, {{165, 160, 152}}));
  scene.boxes.push_back(view.box(
      {-0.14, 0, 0}, {0.8, 0.6}, {0.24, 0.16, 0.19}, Texture::print, cardboard));
  scene.boxes.push_back(view.box({0.18, 0.04, 0},
                                 {0.6, -0.8},
                                 {0.20, 0.13, 0.06},
                                 Texture::print,
                                 {{90, 130, 185}}));
  return scene;
}

// A wooden crate on a concrete block, seen by a camera whose pose is known.
Scene
stacked()
{
  const View view = View::lookAt({-0.35, -1.1, 1.0}, {0, 0, 0.17});
  Scene scene = kinectScene("stacked", 12, view);
  scene.pose_known = true;
  scene.patches.push_back(view.ground({0.5, 0.4}, Texture::plain, {{120, 118, 112}}));
  scene.boxes.push_back(
      view.box({0, 0, 0}, {0.9, 0.436}, {0.40, 0.30, 0.20}, Texture::concrete, grey));
  scene.boxes.push_back(view.box(
      {0.02, 0.01, 0.20}, {0.75, 0.66}, {0.28, 0.20, 0.16}, Texture::wood, timber));
  return scene;
}

// A slab of concrete, 20 : 1, on two battens.
Scene
slab()
{
  const View view = View::lookAt({0.1, -1.5, 1.35}, {0, 0, 0.05});
  Scene scene = kinectScene("slab", 13, view);
  scene.patches.push_back(view.ground({0.7, 0.6}, Texture::plain, {{105, 112, 100}}));
  scene.boxes.push_back(
      view.box({0, 0, 0.06}, {0.8, 0.6}, {0.90, 0.50, 0.045}, Texture::concrete, grey));
  for (const double side : {-1.0, 1.0})
    scene.boxes.push_back(view.box({side * 0.24, side * 0.18, 0},
                                   {-0.6, 0.8},
                                   {0.48, 0.06, 0.06},
                                   Texture::wood,
                                   timber));
  return scene;
}

// Two boxes among two cylinders, which are no cuboids.
Scene
cylinders()
{
  const View view = View::lookAt({0, -0.85, 0.75}, {0, 0, 0.06});
  Scene scene = kinectScene("cylinders", 14, view);
  scene.patches.push_back(view.ground({0.4, 0.3}, Texture::plain, {{160, 150, 140}}));
  scene.boxes.push_back(view.box({-0.05, 0.1, 0},
                                 {0.7, 0.714},
                                 {0.18, 0.12, 0.14},
                                 Texture::stripes,
                                 {{200, 80, 60}}));
  scene.boxes.push_back(view.box({0.2, -0.1, 0},
                                 {0.95, -0.3},
                                 {0.14, 0.10, 0.08},
                                 Texture::plain,
                                 {{70, 130, 90}}));
  scene.cylinders.push_back(
      view.cylinder({-0.22, -0.08, 0}, 0.05, 0.18, {{170, 170, 180}}));
  scene.cylinders.push_back(view.cylinder({0.2, 0.15, 0}, 0.07, 0.12, {{60, 90, 150}}));
  return scene;
}

// A crate in front of a stereo camera: a Bumblebee file.
Scene
crate()
{
  const View view = View::lookAt({0.2, -1.0, 0.85}, {0, 0, 0.1});
  Scene scene = stereoScene("crate", 15, view);
  scene.patches.push_back(view.ground({0.4, 0.32}, Texture::concrete, grey));
  scene.boxes.push_back(
      view.box({0, 0, 0}, {0.85, 0.527}, {0.40, 0.26, 0.24}, Texture::wood, timber));
  return scene;
}

// Blocks seen by a stereo camera: a Bumblebee file.
Scene
blocks()
{
  const View view = View::lookAt({-0.15, -1.05, 0.9}, {0, 0, 0.08});
  Scene scene = stereoScene("blocks", 16, view);
  scene.patches.push_back(view.ground({0.45, 0.3}, Texture::plain, {{130, 125, 118}}));
  scene.boxes.push_back(view.box({-0.18, 0, 0},
                                 {0.75, 0.66},
                                 {0.28, 0.18, 0.20},
                                 Texture::plain,
                                 {{175, 75, 60}}));
  scene.boxes.push_back(view.box(
      {0.2, 0.02, 0}, {0.6, -0.8}, {0.24, 0.20, 0.15}, Texture::concrete, grey));
  return scene;
}

} // namespace

std::vector<Scene>
sampleScenes()
{
  return {cartons(), stacked(), slab(), cylinders(), crate(), blocks()};
}

} // namespace samples
} // namespace hoist
