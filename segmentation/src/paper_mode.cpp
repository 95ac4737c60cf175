#include <hoist/segmentation/extract_line_segments.h>
#include <hoist/segmentation/paper_mode.h>

#include <opencv2/imgproc.hpp>

#include <cmath>
#include <iterator>
#include <stdexcept>

namespace hoist {
namespace {

// The fragment of the image that the mask covers, with room for its outermost edges:
// Canny gives none on the border of its image.
cv::Rect
fragmentOf(const cv::Mat1b& mask, cv::Size size)
{
  constexpr int room = 2; // [px]
  const cv::Rect frame(cv::Point(0, 0), size);
  if (mask.empty())
    return frame;
  const cv::Rect box = cv::boundingRect(mask);
  if (box.empty())
    return box;
  return (box + cv::Size(2 * room, 2 * room) - cv::Point(room, room)) & frame;
}

// Adds a round's finds to those of earlier rounds, whose numbers come first.
void
append(PaperModeResult& round, PaperModeResult& all)
{
  const int segments = static_cast<int>(all.segments.size());
  const int vertices = static_cast<int>(all.vertices.size());
  for (Vertex& vertex : round.vertices)
    for (SegmentEnd& end : vertex.ends)
      end.segment += segments;
  for (Cuboid& cuboid : round.cuboids) {
    for (int& segment : cuboid.segments)
      segment += segments;
    for (int& vertex : cuboid.vertices)
      vertex += vertices;
  }
  const auto move = [](auto& from, auto& to) {
    to.insert(to.end(),
              std::make_move_iterator(from.begin()),
              std::make_move_iterator(from.end()));
  };
  move(round.segments, all.segments);
  move(round.vertices, all.vertices);
  move(round.cuboids, all.cuboids);
  cv::bitwise_or(all.edges, round.edges, all.edges);
}

} // namespace

bool
PaperModeParameters::valid() const
{
  return first_scale > 0 && std::isfinite(first_scale) && scale_factor > 0 &&
         scale_factor < 1 && max_rounds >= 1 && hough.valid() &&
         end_search_radius >= 0 && min_length >= 0 && std::isfinite(min_length) &&
         distance_threshold >= 0 && std::isfinite(distance_threshold) &&
         tolerance >= 0 && std::isfinite(tolerance) && max_degree >= 3;
}

bool
PaperMode::segment(const FrameImages& images,
                   const cv::Mat1b& mask,
                   const PaperModeParameters& parameters,
                   PaperModeResult& result,
                   Diagnostics& diagnostics)
{
  result.clear();
  if (!parameters.valid())
    throw std::invalid_argument("hoist::PaperMode: a parameter is out of range");
  if (!mask.empty() && mask.size() != images.points.size())
    throw std::invalid_argument("hoist::PaperMode: mask and frame differ in size");
  if (!images.hasColor())
    return false;
  result.edges.create(images.points.size());
  result.edges.setTo(0);
  const cv::Rect fragment = fragmentOf(mask, images.points.size());
  if (fragment.empty())
    return true;

  clustering_.setDistanceThreshold(parameters.distance_threshold);
  models_.setTolerance(parameters.tolerance);
  models_.setNormalized(parameters.normalized);
  models_.setMaxDegree(parameters.max_degree);
  CannyParameters canny = parameters.canny;
  // texture is measured against the frame, however small the fragment is
  if (canny.texture_window == 0)
    canny.texture_window = std::max(1, images.width() / 40);
  if (canny.straight_length == 0)
    canny.straight_length = images.width() / 32.0;

  canny_.setImage(images.gray(fragment), canny.blur_sigma);
  Diagnostics rounds;
  int round = 0;
  double scale = parameters.first_scale;
  for (; round < parameters.max_rounds; ++round, scale *= parameters.scale_factor) {
    canny.threshold_scale = scale;
    canny_.detect(canny, fragment_edges_);
    round_.edges.create(images.points.size());
    round_.edges.setTo(0);
    fragment_edges_.copyTo(round_.edges(fragment));
    if (!mask.empty())
      round_.edges.setTo(0, mask == 0);
    if (parameters.stop_when_satisfied) {
      rounds.clear();
      result.clear();
    }
    runRound(images, parameters, round_, rounds);
    append(round_, result);
    if (parameters.stop_when_satisfied && !result.cuboids.empty()) {
      ++round;
      break;
    }
  }
  const std::size_t several = keepBestOfEachBox(result.cuboids);
  diagnostics.counts.add("rounds", static_cast<std::size_t>(round));
  for (const auto& [name, n] : rounds.counts.entries())
    diagnostics.counts.add(name, n);
  diagnostics.counts.add("cuboids", result.cuboids.size());
  for (const auto& [name, n] : rounds.rejected.entries())
    diagnostics.rejected.add(name, n);
  if (several > 0)
    diagnostics.rejected.add("same box, lower score", several);
  return true;
}

void
PaperMode::runRound(const FrameImages& images,
                    const PaperModeParameters& parameters,
                    PaperModeResult& result,
                    Diagnostics& diagnostics)
{
  diagnostics.counts.add("edge pixels",
                         static_cast<std::size_t>(cv::countNonZero(result.edges)));
  LineExtractionParameters lines;
  lines.lift = LineLift::endpoints;
  lines.hough = parameters.hough;
  lines.end_search_radius = parameters.end_search_radius;
  lines.min_length = parameters.min_length;
  extractLineSegments(images, result.edges, lines, result.segments, diagnostics);
  clustering_.cluster(result.segments, result.vertices);
  diagnostics.counts.add("vertices", result.vertices.size());
  models_.find(result.segments, result.vertices, result.cuboids, diagnostics);
}

} // namespace hoist
