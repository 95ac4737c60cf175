#include "overlay.h"

#include "background.h"
#include "cuboid_drawing.h"
#include "drawing.h"
#include "labels.h"
#include "palette.h"
#include "wireframe.h"

#include <hoist/filters/edge_kind.h>

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

namespace hoist {
namespace {

bool
anyOf(const cv::Mat1b& kinds, int kind)
{
  return std::any_of(
      kinds.begin(), kinds.end(), [kind](unsigned char k) { return (k & kind) != 0; });
}

// Depth explains an edge better than colour does; creases of noise are many, so they
// are faint.
void
drawEdges(cv::Mat3b& image, const cv::Mat1b& kinds, int scale)
{
  for (int v = 0; v < kinds.rows; ++v)
    for (int u = 0; u < kinds.cols; ++u) {
      const int kind = kinds(v, u);
      if (kind == 0)
        continue;
      const bool occlusion = (kind & EDGE_OCCLUSION) != 0;
      const bool crease = !occlusion && (kind & EDGE_CREASE) != 0;
      const cv::Scalar& color = occlusion
                                    ? occlusion_edge_color
                                    : (crease ? crease_edge_color : color_edge_color);
      const double ink = occlusion ? 0.5 : (crease ? 0.25 : 0.35);
      cv::Mat3b cell = image(cv::Rect(u * scale, v * scale, scale, scale));
      cell = (1.0 - ink) * cell + color * ink;
    }
}

std::vector<std::string>
labelText(const RecognizedCuboid& recognized, std::size_t number)
{
  const Cuboid& cuboid = recognized.cuboid;
  char score[48];
  std::snprintf(score, sizeof score, "score %.2f", cuboid.score);
  std::string second = score;
  if (!recognized.features.color_name.empty())
    second += "  " + recognized.features.color_name;
  if (recognized.features.weight > 0) {
    char weight[48];
    std::snprintf(weight, sizeof weight, "  %.3g kg", recognized.features.weight);
    second += weight;
  }
  return {numberAndSizes(cuboid, number), second};
}

double
distanceToLine(cv::Point2f p, const EdgePiece& edge)
{
  const cv::Point2f way = edge.to - edge.from;
  const double length = cv::norm(way);
  if (length == 0)
    return cv::norm(p - edge.from);
  const double along =
      std::clamp((p - edge.from).dot(way) / (length * length), 0.0, 1.0);
  return cv::norm(p - (edge.from + way * along));
}

// Both ends lie on one seen edge of a cuboid, within \a reach pixels.
bool
supports(cv::Point2f p,
         cv::Point2f q,
         const std::vector<std::vector<EdgePiece>>& edges,
         double reach)
{
  for (const auto& cuboid : edges)
    for (const EdgePiece& edge : cuboid)
      if (!edge.hidden && distanceToLine(p, edge) <= reach &&
          distanceToLine(q, edge) <= reach)
        return true;
  return false;
}

// Segments on a cuboid's edges are strong, the others faint.
void
drawSegments(cv::Mat3b& image,
             const std::vector<LineSegment>& segments,
             const std::vector<std::vector<EdgePiece>>& edges,
             int scale)
{
  const auto at = [&](const Eigen::Vector2f& pixel) {
    return cv::Point2f(scale * (pixel.x() + 0.5f), scale * (pixel.y() + 0.5f));
  };
  cv::Mat3b faint = image.clone();
  for (const LineSegment& s : segments)
    cv::line(faint, at(s.pixels[0]), at(s.pixels[1]), segment_color, 1, cv::LINE_AA);
  cv::addWeighted(faint, 0.35, image, 0.65, 0.0, image);
  for (const LineSegment& s : segments)
    if (supports(at(s.pixels[0]), at(s.pixels[1]), edges, 4.0 * scale))
      cv::line(image,
               at(s.pixels[0]),
               at(s.pixels[1]),
               segment_color,
               std::max(1, scale / 2),
               cv::LINE_AA);
}

void
drawVertices(cv::Mat3b& image, const OverlayContents& contents, int scale, int radius)
{
  const Intrinsics& camera = contents.images.intrinsics;
  for (const Vertex& v : contents.vertices) {
    if (v.point.z() <= 0 || !camera.valid())
      continue;
    const Eigen::Vector2d uv = camera.project(v.point) + Eigen::Vector2d(0.5, 0.5);
    cv::circle(image,
               cv::Point(cvRound(scale * uv.x()), cvRound(scale * uv.y())),
               radius,
               vertex_color,
               1,
               cv::LINE_AA);
  }
}

std::string
summary(const FrameResult& result)
{
  const std::size_t n = result.cuboids.size();
  std::string text = result.scene + "   " + result.mode + " mode   " +
                     std::to_string(n) + (n == 1 ? " cuboid" : " cuboids");
  const auto& reasons = result.diagnostics.rejected.entries();
  if (n == 0 && !reasons.empty()) {
    const auto most = std::max_element(
        reasons.begin(), reasons.end(), [](const auto& a, const auto& b) {
          return a.second < b.second;
        });
    text += std::string("; most rejected: ") + most->first;
  }
  return text;
}

cv::Mat3b
footer(const OverlayContents& contents, int width, int text_scale)
{
  std::vector<LegendEntry> legend;
  if (anyOf(contents.edges, EDGE_COLOR))
    legend.push_back({"colour edge", color_edge_color, LegendMark::square});
  if (anyOf(contents.edges, EDGE_OCCLUSION))
    legend.push_back({"occlusion edge", occlusion_edge_color, LegendMark::square});
  if (anyOf(contents.edges, EDGE_CREASE))
    legend.push_back({"crease edge", crease_edge_color, LegendMark::square});
  if (!contents.segments.empty())
    legend.push_back({"segment", segment_color, LegendMark::line});
  if (!contents.vertices.empty())
    legend.push_back({"vertex", vertex_color, LegendMark::ring});
  return drawFooter(summary(contents.result), legend, width, text_scale);
}

} // namespace

cv::Mat3b
drawOverlay(const OverlayContents& contents)
{
  const FrameImages& images = contents.images;
  const int scale = enlargement(images.width());
  const int text_scale = textScaleOf(images.width() * scale);
  cv::Mat3b image = background(images, scale);
  if (!contents.edges.empty())
    drawEdges(image, contents.edges, scale);

  std::vector<Cuboid> cuboids;
  for (const RecognizedCuboid& recognized : contents.result.cuboids)
    cuboids.push_back(recognized.cuboid);
  if (!images.intrinsics.valid())
    cuboids.clear(); // nothing says where in the picture they are
  const Wireframes wireframes(cuboids, images, scale);
  std::vector<std::vector<EdgePiece>> edges;
  for (std::size_t i = 0; i < cuboids.size(); ++i)
    edges.push_back(wireframes.edges(i));

  const cv::Mat1i owners = wireframes.owners(image.size());
  constexpr double faint = 0.05; // the picture's own colours stay readable
  tintCuboids(image, owners, faint);
  drawSegments(image, contents.segments, edges, scale);
  drawVertices(image, contents, scale, 4 * text_scale);
  drawCuboidEdges(image, edges, scale, std::vector<int>(edges.size(), scale));
  LabelPlacer labels(owners, text_scale);
  for (std::size_t i = 0; i < cuboids.size(); ++i)
    labels.add(
        labelText(contents.result.cuboids[i], i), static_cast<int>(i), cuboidColor(i));
  labels.draw(image);

  cv::Mat3b picture;
  cv::vconcat(image, footer(contents, image.cols, text_scale), picture);
  return picture;
}

} // namespace hoist
