#include "viewer/viewer.h"

#include "batch/stop_signal.h"
#include "png.h"
#include "viewer/picture.h"

#include <fmt/format.h>

#include <vtkRenderer.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <thread>
#include <utility>

namespace hoist {
namespace {

namespace fs = std::filesystem;

std::string
nameOf(const std::string& file)
{
  return fs::path(file).filename().string();
}

} // namespace

Viewer::Viewer(std::vector<std::string> files,
               const ViewerSettings& settings,
               LiveSettings& live,
               ViewerWindow::Kind kind)
: files_(std::move(files))
, given_(settings)
, live_(live)
, window_("hoist_viewer", settings.size, kind)
, loader_(files_, settings.beside, live.settings())
, cloud_(window_.visualizer())
, layers_(window_.space(), window_.above())
, image_(window_.image())
, hud_(window_.words())
, shown_(layersOf(settings))
, camera_file_(settings.camera)
{
  arrange();
  if (!camera_file_.empty()) {
    window_.setCamera(readCameraFile(camera_file_));
    camera_placed_ = true;
  }
  window_.setHandlers(
      [this](const std::string& symbol, bool ctrl, bool alt) {
        return onKey(symbol, ctrl, alt);
      },
      [this](int x, int y, bool shift) { return onClick(x, y, shift); });
  step(0);
}

void
Viewer::run(const StopSignal& signal)
{
  showWords();
  draw();
  while (!window_.closed() && signal.received() == 0) {
    window_.processEvents();
    if (poll() && !window_.closed())
      draw();
  }
}

bool
Viewer::stop()
{
  // a frame and its recognition take less; a file of gigabytes takes minutes
  constexpr std::chrono::milliseconds patience(2000);
  return loader_.stop(patience);
}

void
Viewer::draw()
{
  window_.render();
  if (!given_.verbose || waiting_ || !asked_)
    return;
  window_.waitUntilDrawn();
  const std::chrono::duration<double, std::milli> time =
      std::chrono::steady_clock::now() - *asked_;
  fmt::print(stderr,
             "on the screen {:.0f} ms after it was asked for, {}\n",
             time.count(),
             was_ready_ ? "was ready" : "was not ready");
  asked_.reset();
}

bool
Viewer::takeScreenshots()
{
  const auto count = std::min(files_.size(), static_cast<std::size_t>(given_.frames));
  bool good = true;
  for (std::size_t i = 0; i < count; ++i) {
    step(i);
    while (loader_.wanted() == nullptr)
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    poll();
    fs::path path = given_.screenshot;
    if (given_.frames > 1) // as many digits as the last one has
      path.replace_filename(fmt::format("{}-{:0{}}{}",
                                        path.stem().string(),
                                        i + 1,
                                        std::to_string(count).size(),
                                        path.extension().string()));
    progress_.clear(); // the same picture however far the thread is
    showWords();
    savePng(path.string(), window_.capture());
    good = good && scene_->error.empty();
  }
  return good;
}

// Looks what the thread does; true if there is something new to see.
bool
Viewer::poll()
{
  bool changed = takeOver();
  const std::string progress = loader_.activity();
  if (progress != progress_ || window_.size() != drawn_size_) {
    progress_ = progress;
    if (window_.size() != drawn_size_)
      arrange();
    changed = true;
  }
  if (changed)
    showWords();
  return changed;
}

// Takes over the wanted scene if it is made.
bool
Viewer::takeOver()
{
  if (!waiting_)
    return false;
  const Scene::ConstPtr scene = loader_.wanted();
  if (!scene)
    return false;
  waiting_ = false;
  showScene(scene);
  return true;
}

void
Viewer::step(std::size_t index)
{
  index_ = index;
  message_.clear();
  loader_.want(index);
  await();
}

// Another scene is wanted from now on.
void
Viewer::await()
{
  asked_ = std::chrono::steady_clock::now();
  was_ready_ = loader_.wanted() != nullptr;
  waiting_ = true;
}

void
Viewer::showScene(const Scene::ConstPtr& scene)
{
  const bool same_file = scene_ && scene_->file == scene->file;
  if (!same_file)
    unpick();
  selected_ = -1; // numbers may have changed
  selected_rejection_ = -1;
  scene_ = scene;
  const std::size_t n = scene->result.cuboids.size();
  window_.setTitle(fmt::format(
      "hoist_viewer - {} [{}/{}]", nameOf(scene->file), index_ + 1, files_.size()));
  cloud_.show(*scene);
  showLayers();
  placeCamera();
  if (!scene->error.empty())
    fmt::print(stderr, "hoist_viewer: {}\n", scene->error);
  for (const std::string& warning : scene->warnings)
    fmt::print(stderr, "hoist_viewer: {}: {}\n", scene->file, warning);
  if (scene->error.empty())
    fmt::print(stderr,
               "[{}/{}] {}: {} cuboid{}, {:.0f} ms\n",
               index_ + 1,
               files_.size(),
               scene->file,
               n,
               n == 1 ? "" : "s",
               scene->time);
}

void
Viewer::showLayers()
{
  if (!scene_)
    return;
  cloud_.setVisible(shown_.shows(Layer::cloud));
  const Highlight highlight{selected_, selected_rejection_, labels_};
  layers_.show(*scene_, shown_, highlight);
  image_.setPicture(drawPicture(*scene_, shown_, highlight), pictureScale(*scene_));
  mark(pixel_);
}

// At the sensor, as wide as its picture.
ViewCamera
Viewer::firstCamera(const Scene& scene) const
{
  ViewCamera camera;
  const FrameImages& images = *scene.frame->images;
  const Eigen::Isometry3d pose = scene.pose();
  std::vector<float> depths;
  for (const float w : images.inverse_depth)
    if (w > 0)
      depths.push_back(w);
  double far = 1;
  if (!depths.empty()) {
    const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
    std::nth_element(depths.begin(), middle, depths.end());
    far = 1.0 / *middle;
  }
  camera.position = pose.translation();
  camera.focal = pose * Eigen::Vector3d(0, 0, far);
  camera.up = pose.linear() * -Eigen::Vector3d::UnitY();
  if (images.intrinsics.valid()) {
    const cv::Rect area = window_.spaceArea();
    const double aspect = static_cast<double>(area.width) / std::max(1, area.height);
    const double high = 0.5 * images.height() / images.intrinsics.fy;
    const double wide = 0.5 * images.width() / images.intrinsics.fx / aspect;
    camera.angle = 2 * std::atan(std::max(high, wide));
  }
  return camera;
}

void
Viewer::placeCamera()
{
  if (!scene_->hasFrame())
    return;
  const Eigen::Isometry3d pose = scene_->pose();
  Eigen::AlignedBox3d bounds(pose.translation());
  const FrameImages& images = *scene_->frame->images;
  for (int v = 0; v < images.height(); v += 4)
    for (int u = 0; u < images.width(); u += 4)
      if (images.inverse_depth(v, u) > 0) {
        const cv::Vec3f& p = images.points(v, u);
        bounds.extend(pose * Eigen::Vector3d(p[0], p[1], p[2]));
      }
  for (const RecognizedCuboid& recognized : scene_->result.cuboids)
    for (int i = 0; i < 8; ++i)
      bounds.extend(pose * recognized.cuboid.corners().col(i));
  if (!camera_placed_) {
    window_.setCamera(firstCamera(*scene_));
    // so that points touch where they are seen from the sensor
    const cv::Size area = window_.spaceArea().size();
    cloud_.setPointSize(
        std::ceil(std::min(static_cast<double>(area.width) / images.width(),
                           static_cast<double>(area.height) / images.height())));
  }
  else if (!pose.isApprox(pose_) && given_.camera.empty()) {
    // it stays where it was in the eyes of the sensor
    const Eigen::Isometry3d moved = pose * pose_.inverse();
    ViewCamera camera = window_.camera();
    camera.position = moved * camera.position;
    camera.focal = moved * camera.focal;
    camera.up = moved.linear() * camera.up;
    window_.setCamera(camera);
  }
  camera_placed_ = true;
  pose_ = pose;
  window_.setBounds(bounds);
}

// The views have what the column leaves.
void
Viewer::arrange()
{
  drawn_size_ = window_.size();
  window_.setLayout(layout_, legend_shown_ ? Hud::columnWidth(drawn_size_) : 0);
  image_.fit();
}

void
Viewer::showWords()
{
  hud_.show(words(), drawn_size_, legend_shown_ ? Hud::columnWidth(drawn_size_) : 0);
}

void
Viewer::say(const std::string& text)
{
  message_ = text;
  fmt::print("{}\n", text);
  std::fflush(stdout);
}

} // namespace hoist
