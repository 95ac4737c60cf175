// What the viewer says: legend, card, lines.
#include "viewer/viewer.h"

#include <hoist/filters/edge_kind.h>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

namespace hoist {
namespace {

const cv::Scalar bright(235, 235, 235);
const cv::Scalar dim(125, 125, 125);

long
countOf(const Scene& scene, Layer layer)
{
  const auto pixels = [&](int kind) {
    return std::count_if(scene.edges.begin(),
                         scene.edges.end(),
                         [kind](unsigned char k) { return (k & kind) != 0; });
  };
  switch (layer) {
  case Layer::cloud:
    return scene.frame ? cv::countNonZero(scene.frame->images->inverse_depth) : 0;
  case Layer::color_edges:
    return pixels(EDGE_COLOR);
  case Layer::occlusion_edges:
    return pixels(EDGE_OCCLUSION);
  case Layer::crease_edges:
    return pixels(EDGE_CREASE);
  case Layer::segments:
    return static_cast<long>(scene.segments.size());
  case Layer::vertices:
    return static_cast<long>(scene.vertices.size());
  case Layer::faces: {
    long faces = 0;
    for (const RecognizedCuboid& recognized : scene.result.cuboids)
      faces += std::count(recognized.cuboid.observed_faces.begin(),
                          recognized.cuboid.observed_faces.end(),
                          true);
    return faces;
  }
  case Layer::rejected:
    return static_cast<long>(scene.rejected.size());
  case Layer::detections:
    return static_cast<long>(scene.detections.size());
  case Layer::truth:
    return scene.truth ? static_cast<long>(scene.truth->objects.size()) : 0;
  default:
    return static_cast<long>(scene.result.cuboids.size());
  }
}

} // namespace

std::vector<HudLine>
Viewer::legend() const
{
  std::vector<HudLine> lines;
  for (const LayerInfo& info : layerTable()) {
    const bool on = shown_.shows(info.layer);
    HudLine line;
    line.text = fmt::format("{:<4}{:<21}", info.key, info.text);
    if (scene_)
      line.text += fmt::format("{:>7}", countOf(*scene_, info.layer));
    line.color = on ? bright : dim;
    line.swatch = on ? info.color : cv::Scalar(60, 56, 54);
    line.layer = info.layer;
    lines.push_back(line);
  }
  if (!scene_ || scene_->result.diagnostics.rejected.entries().empty())
    return lines;
  auto reasons = scene_->result.diagnostics.rejected.entries();
  std::stable_sort(reasons.begin(), reasons.end(), [](const auto& a, const auto& b) {
    return a.second > b.second;
  });
  constexpr std::size_t most = 6;
  reasons.resize(std::min(reasons.size(), most));
  lines.push_back({});
  lines.push_back({"why not:", infoOf(Layer::rejected).color, {}, {}});
  for (const auto& [reason, count] : reasons)
    lines.push_back({fmt::format("{:>6} {}", count, std::string(reason).substr(0, 32)),
                     dim,
                     {},
                     {}});
  return lines;
}

std::vector<HudLine>
Viewer::card() const
{
  std::optional<cv::Scalar> swatch;
  if (scene_ && selected_ >= 0) {
    const CuboidFeatures& features =
        scene_->result.cuboids[static_cast<std::size_t>(selected_)].features;
    if (!features.color_name.empty())
      swatch = cv::Scalar(features.rgb[2], features.rgb[1], features.rgb[0]);
  }
  std::vector<HudLine> lines;
  for (const std::string& text : cardLines()) {
    lines.push_back({text, bright, {}, {}});
    if (text.rfind("colour", 0) == 0)
      lines.back().swatch = swatch;
  }
  return lines;
}

HudContent
Viewer::words() const
{
  HudContent content;
  if (legend_shown_)
    content.legend = legend();
  content.card = card();
  const std::string& file = files_[index_];
  content.status = fmt::format("[{}/{}] {}",
                               index_ + 1,
                               files_.size(),
                               std::filesystem::path(file).filename().string());
  if (waiting_)
    content.status += "   ...";
  else if (scene_->error.empty()) {
    const std::size_t n = scene_->result.cuboids.size();
    content.status += fmt::format(
        "   {} mode   {} cuboid{}", scene_->result.mode, n, n == 1 ? "" : "s");
  }
  if (!waiting_ && !scene_->error.empty())
    content.notice = scene_->error;
  content.progress = progress_.empty() ? "h: help" : progress_ + " ...";
  content.message = message_;
  if (help_shown_) {
    std::istringstream text(keysText());
    for (std::string line; std::getline(text, line);)
      content.help.push_back({line, bright, {}, {}});
  }
  return content;
}

} // namespace hoist
