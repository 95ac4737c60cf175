// What the viewer does when a key is pressed or something is clicked.
#include "viewer/viewer.h"

#include <hoist/data/atomic_file.h>

#include <pcl/console/print.h>
#include <pcl/io/pcd_io.h>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
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
    draw();
    return true;
  }
  const std::optional<KeyAction> action = actionOf(symbol, ctrl, alt);
  if (!action)
    return false;
  try {
    act(*action);
    takeOver(); // at once, where the thread was faster than the user
  }
  catch (const std::exception& error) { // e.g. a full disk: said, not died of
    fmt::print(stderr, "hoist_viewer: {}\n", error.what());
    message_ = error.what();
  }
  showWords();
  draw();
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
    selectNext();
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
    if (help_shown_) {
      fmt::print("{}{}", layerKeysText(), keysText());
      std::fflush(stdout);
    }
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
  await();
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
  draw();
  return true;
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
