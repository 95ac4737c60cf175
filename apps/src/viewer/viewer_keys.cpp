// What the viewer does when a key is pressed or something is clicked.
#include "viewer/card.h"
#include "viewer/shapes.h"
#include "viewer/viewer.h"

#include <hoist/data/atomic_file.h>

#include <pcl/console/print.h>
#include <pcl/io/pcd_io.h>

#include <fmt/format.h>

#include <vtkActor.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <filesystem>

namespace hoist {

namespace fs = std::filesystem;

bool
Viewer::onKey(const std::string& symbol, bool ctrl, bool alt)
{
  if (const std::optional<Layer> layer = layerOf(symbol); layer && !ctrl && !alt) {
    shown_.toggle(*layer);
    showLayers();
    showWords();
    window_.render();
    return true;
  }
  const std::optional<KeyAction> action = actionOf(symbol, ctrl, alt);
  if (!action)
    return false;
  try {
    act(*action);
  }
  catch (const std::exception& error) { // e.g. a full disk: said, not died of
    fmt::print(stderr, "hoist_viewer: {}\n", error.what());
    message_ = error.what();
  }
  showWords();
  window_.render();
  return *action != KeyAction::toggle_help; // PCL prints its own help as well
}

void
Viewer::act(KeyAction action)
{
  const std::size_t last = files_.size() - 1;
  switch (action) {
  case KeyAction::next:
    index_ < last ? step(index_ + 1) : say("this is the last file");
    break;
  case KeyAction::previous:
    index_ > 0 ? step(index_ - 1) : say("this is the first file");
    break;
  case KeyAction::first:
    step(0);
    break;
  case KeyAction::last:
    step(last);
    break;
  case KeyAction::next_cuboid:
    if (scene_ && !scene_->result.cuboids.empty())
      select((selected_ + 1) % static_cast<int>(scene_->result.cuboids.size()));
    break;
  case KeyAction::close_card:
    help_shown_ = false;
    unpick();
    showLayers();
    break;
  case KeyAction::labels:
    labels_ = !labels_;
    showLayers();
    break;
  case KeyAction::export_points:
    exportPoints();
    break;
  case KeyAction::save_settings:
    saveSettings();
    break;
  case KeyAction::toggle_mode:
    live_.toggleMode();
    tune(true);
    break;
  case KeyAction::next_parameter:
    live_.choose(1);
    say(live_.chosen());
    break;
  case KeyAction::lower:
    tune(live_.step(-1));
    break;
  case KeyAction::raise:
    tune(live_.step(1));
    break;
  case KeyAction::reset_parameters:
    live_.reset();
    tune(true);
    break;
  case KeyAction::next_layout:
    layout_ = layout_ == Layout::both
                  ? Layout::space
                  : (layout_ == Layout::space ? Layout::image : Layout::both);
    arrange();
    break;
  case KeyAction::hide_text:
    legend_shown_ = !legend_shown_;
    arrange();
    break;
  case KeyAction::toggle_help:
    help_shown_ = !help_shown_;
    if (help_shown_)
      fmt::print("{}{}", layerKeysText(), keysText());
    break;
  case KeyAction::save_camera:
    saveCamera();
    break;
  case KeyAction::restore_camera:
    restoreCamera();
    break;
  }
}

// Recognises again if something has changed.
void
Viewer::tune(bool changed)
{
  if (!changed) {
    say(live_.chosen() + " is as far as keys go");
    return;
  }
  say(live_.settings().mode + " mode, " + live_.chosen());
  loader_.setSettings(live_.settings());
  waiting_ = true;
}

bool
Viewer::onClick(int x, int y, bool shift)
{
  if (const std::optional<Layer> layer = hud_.layerAt(x, y)) {
    shown_.toggle(*layer);
    showLayers();
  }
  else if (!window_.inSpace(x, y))
    pickPixel(image_.pixelAt(x, y), shift);
  else if (shift)
    pickInSpace(x, y);
  else
    return false;
  showWords();
  window_.render();
  return true;
}

void
Viewer::unpick()
{
  selected_ = -1;
  selected_rejection_ = -1;
  mark({-1, -1});
}

void
Viewer::mark(cv::Point pixel)
{
  pixel_ = pixel;
  image_.mark(pixel);
  if (marker_)
    window_.above()->RemoveViewProp(marker_);
  marker_ = nullptr;
  if (pixel.x < 0 || !scene_ || !scene_->hasFrame() ||
      !(scene_->frame->images->inverse_depth(pixel) > 0))
    return;
  const cv::Vec3f& p = scene_->frame->images->points(pixel);
  const vtkSmartPointer<vtkActor> actor =
      pointsActor({scene_->pose() * Eigen::Vector3d(p[0], p[1], p[2])},
                  cv::Scalar(60, 60, 255),
                  11.0F);
  actor->GetProperty()->SetRenderPointsAsSpheres(true);
  marker_ = actor;
  window_.above()->AddViewProp(marker_);
}

void
Viewer::pickPixel(cv::Point pixel, bool card)
{
  if (pixel.x < 0 || !scene_ || !scene_->hasFrame())
    return;
  const FrameImages& images = *scene_->frame->images;
  mark(pixel);
  const cv::Vec3f& p = images.points(pixel);
  const int index = pixel.y * images.width() + pixel.x;
  if (images.inverse_depth(pixel) > 0)
    say(fmt::format("pixel {} {}: point {}: {:.4f} {:.4f} {:.4f} m",
                    pixel.x,
                    pixel.y,
                    index,
                    p[0],
                    p[1],
                    p[2]));
  else
    say(fmt::format("pixel {} {}: nothing was measured", pixel.x, pixel.y));
  if (!card || !images.intrinsics.valid())
    return;
  std::vector<Cuboid> cuboids;
  for (const RecognizedCuboid& recognized : scene_->result.cuboids)
    cuboids.push_back(recognized.cuboid);
  const Eigen::Vector3d ray = images.intrinsics.ray(pixel.x, pixel.y).normalized();
  select(pickCuboid(cuboids, {Eigen::Vector3d::Zero(), ray, 0}));
}

void
Viewer::pickInSpace(int x, int y)
{
  if (!scene_ || !scene_->hasFrame())
    return;
  constexpr double reach = 4.0; // [px]
  SightLine line = window_.sightLine(x, y, reach);
  const Eigen::Isometry3d to_sensor = scene_->pose().inverse();
  line.origin = to_sensor * line.origin;
  line.way = to_sensor.linear() * line.way;
  const FrameImages& images = *scene_->frame->images;
  const int index = pickPoint(images, line);
  if (index >= 0)
    pickPixel({index % images.width(), index / images.width()}, false);
  std::vector<Cuboid> cuboids;
  for (const RecognizedCuboid& recognized : scene_->result.cuboids)
    cuboids.push_back(recognized.cuboid);
  const int cuboid = pickCuboid(cuboids, line);
  select(cuboid);
  if (cuboid >= 0 || !shown_.shows(Layer::rejected))
    return;
  std::vector<Cuboid> rejected;
  for (const CuboidVerdict& verdict : shownRejections(*scene_))
    rejected.push_back(verdict.cuboid);
  selected_rejection_ = pickCuboid(rejected, line);
}

void
Viewer::select(int cuboid)
{
  selected_rejection_ = -1;
  if (cuboid != selected_) {
    selected_ = cuboid;
    showLayers();
  }
  if (cuboid < 0)
    return;
  for (const std::string& line : cardText(*scene_, static_cast<std::size_t>(cuboid)))
    fmt::print("{}\n", line);
  std::fflush(stdout);
}

void
Viewer::save(const std::string& file, const std::string& bytes)
{
  fs::create_directories(given_.output);
  const std::string path = (fs::path(given_.output) / file).lexically_normal().string();
  writeFileAtomically(path, bytes);
  say("saved " + path);
}

void
Viewer::exportPoints()
{
  if (selected_ < 0) {
    say("no cuboid is selected: k or Shift+click");
    return;
  }
  const auto number = static_cast<std::size_t>(selected_);
  const auto& indices = scene_->result.cuboids[number].cuboid.indices;
  const auto& cloud = *scene_->frame->loaded.cloud;
  const pcl::PointCloud<pcl::PointXYZRGB> points(cloud, indices);
  if (points.empty()) {
    say("no points belong to this cuboid");
    return;
  }
  fs::create_directories(given_.output);
  const std::string path =
      (fs::path(given_.output) /
       fmt::format("{}_cuboid{}.pcd", scene_->result.scene, number + 1))
          .lexically_normal()
          .string();
  AtomicFile file(path);
  if (pcl::io::savePCDFileBinaryCompressed(file.temporary().string(), points) != 0)
    throw std::runtime_error(path + ": cannot be written");
  file.commit();
  say(fmt::format("saved {} points as {}", points.size(), path));
}

void
Viewer::saveSettings()
{
  save("hoist_settings.yaml", live_.yaml());
}

void
Viewer::saveCamera()
{
  const std::string text = cameraText(window_.camera());
  if (given_.camera.empty()) {
    save("hoist_viewer.cam", text);
    camera_file_ = (fs::path(given_.output) / "hoist_viewer.cam").string();
    return;
  }
  writeFileAtomically(given_.camera, text);
  say("saved " + given_.camera);
}

void
Viewer::restoreCamera()
{
  if (camera_file_.empty()) {
    say("no camera has been saved: Ctrl+s");
    return;
  }
  window_.setCamera(readCameraFile(camera_file_));
  say("camera of " + camera_file_);
}

} // namespace hoist
