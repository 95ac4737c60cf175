#include "overlay.h"

#include "drawing.h"

#include <hoist/filters/edge_kind.h>

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

namespace hoist {
namespace {

constexpr int min_columns = 1280;

// Okabe and Ito's palette (colour-blind safe) without black, lightened where it is
// dark, and three more; BGR.
const cv::Scalar palette[] = {{0, 159, 230},
                              {233, 180, 86},
                              {125, 190, 20},
                              {66, 228, 240},
                              {190, 130, 225},
                              {30, 110, 240},
                              {235, 140, 70},
                              {150, 240, 150},
                              {150, 160, 255},
                              {210, 220, 160}};

const cv::Scalar color_edge(200, 200, 90);
const cv::Scalar occlusion_edge(60, 110, 255);
const cv::Scalar crease_edge(255, 110, 220);
const cv::Scalar segment_color(70, 235, 255);
const cv::Scalar vertex_color(255, 255, 255);

// Depth as grey, near is bright; linear in 1/z between its 2 % and 98 % quantiles.
cv::Mat3b
depthPicture(const cv::Mat1f& inverse_depth)
{
  std::vector<float> values;
  for (const float w : inverse_depth)
    if (w > 0)
      values.push_back(w);
  cv::Mat3b picture(inverse_depth.size(), cv::Vec3b(0, 0, 0));
  if (values.empty())
    return picture;
  std::sort(values.begin(), values.end());
  const float low = values[values.size() / 50];
  const float high = std::max(values[values.size() * 49 / 50], low * 1.0001f);
  for (int v = 0; v < picture.rows; ++v)
    for (int u = 0; u < picture.cols; ++u)
      if (inverse_depth(v, u) > 0) {
        const auto grey = cv::saturate_cast<unsigned char>(
            60 + 195 * (inverse_depth(v, u) - low) / (high - low));
        picture(v, u) = {grey, grey, grey};
      }
  return picture;
}

// 98 % of the pixels are at most this bright; at least 1.
double
brightLevel(const cv::Mat1b& luma)
{
  std::array<int, 256> histogram{};
  for (const unsigned char value : luma)
    ++histogram[value];
  auto rest = static_cast<long>(luma.total() / 50);
  int level = 255;
  while (level > 1 && (rest -= histogram[level]) > 0)
    --level;
  return level;
}

bool
anyOf(const cv::Mat1b& kinds, int kind)
{
  return std::any_of(
      kinds.begin(), kinds.end(), [kind](unsigned char k) { return (k & kind) != 0; });
}

cv::Mat3b
background(const FrameImages& images, int scale)
{
  const cv::Mat3b picture =
      images.bgr.empty() ? depthPicture(images.inverse_depth) : images.bgr;
  cv::Mat3b large, grey;
  cv::resize(picture, large, {}, scale, scale, cv::INTER_CUBIC);
  // Half of the colour goes and the light is brought to one level, darker than the
  // lines, whatever the exposure was.
  cv::Mat1b luma;
  cv::cvtColor(large, luma, cv::COLOR_BGR2GRAY);
  const double gain = std::clamp(150.0 / brightLevel(luma), 0.5, 1.5);
  cv::cvtColor(luma, grey, cv::COLOR_GRAY2BGR);
  cv::Mat3b dimmed;
  cv::addWeighted(large, 0.55 * gain, grey, 0.35 * gain, 0.0, dimmed);
  return dimmed;
}

void
drawEdges(cv::Mat3b& image, const cv::Mat1b& kinds, int scale)
{
  for (int v = 0; v < kinds.rows; ++v)
    for (int u = 0; u < kinds.cols; ++u) {
      const int kind = kinds(v, u);
      if (kind == 0)
        continue;
      // depth explains an edge better than colour does
      const cv::Scalar& color = (kind & EDGE_OCCLUSION) != 0 ? occlusion_edge
                                : (kind & EDGE_CREASE) != 0  ? crease_edge
                                                             : color_edge;
      cv::Mat3b cell = image(cv::Rect(u * scale, v * scale, scale, scale));
      for (cv::Vec3b& pixel : cell)
        for (int c = 0; c < 3; ++c)
          pixel[c] =
              cv::saturate_cast<unsigned char>(0.45 * pixel[c] + 0.55 * color[c]);
    }
}

std::string
sizeText(const Cuboid& cuboid, int i)
{
  char text[32];
  if (cuboid.dimension_source[i] == DimensionSource::unknown)
    return "?";
  std::snprintf(text,
                sizeof text,
                "%s%.1f",
                cuboid.dimension_source[i] == DimensionSource::partial ? ">" : "",
                100.0 * cuboid.size[i]);
  return text;
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
  return {"#" + std::to_string(number + 1) + "  " + sizeText(cuboid, 0) + " x " +
              sizeText(cuboid, 1) + " x " + sizeText(cuboid, 2) + " cm",
          second};
}

// The twelve edges as seen from the origin; hidden ones lie between two faces that
// look away.
class Wireframe {
public:
  Wireframe(const Cuboid& cuboid, const Intrinsics& camera, int scale)
  : corners_(cuboid.corners()), camera_(camera), scale_(scale)
  {
    for (int face = 0; face < 6; ++face) {
      const Eigen::Vector3d normal =
          cuboid.axes.col(face / 2) * (face % 2 == 0 ? 1.0 : -1.0);
      const Eigen::Vector3d centre =
          cuboid.center + normal * (0.5 * cuboid.size[face / 2]);
      front_[face] = normal.dot(centre) < 0;
    }
  }

  void
  fill(cv::Mat3b& image, const cv::Scalar& color) const
  {
    if (corners_.row(2).minCoeff() < near_)
      return;
    cv::Mat3b painted = image.clone();
    for (int face = 0; face < 6; ++face) {
      if (!front_[face])
        continue;
      const int axis = face / 2, side = face % 2 == 0 ? 1 << axis : 0;
      const int a = 1 << (axis + 1) % 3, b = 1 << (axis + 2) % 3;
      std::vector<cv::Point> outline;
      for (const int corner : {side, side | a, side | a | b, side | b})
        outline.emplace_back(pixel(corners_.col(corner)));
      cv::fillConvexPoly(painted, outline, color, cv::LINE_AA);
    }
    cv::addWeighted(painted, 0.16, image, 0.84, 0.0, image);
  }

  void
  draw(cv::Mat3b& image, const cv::Scalar& color, bool hidden) const
  {
    for (int e = 0; e < 12; ++e) {
      const auto& edge = Cuboid::edges()[e];
      const bool visible = front_[faceOf(edge[0], (e / 4 + 1) % 3)] ||
                           front_[faceOf(edge[0], (e / 4 + 2) % 3)];
      if (visible == hidden)
        continue;
      Eigen::Vector3d p = corners_.col(edge[0]), q = corners_.col(edge[1]);
      if (!clip(p, q))
        continue;
      if (hidden)
        drawDashedLine(image, pixel(p), pixel(q), color, 1, 5 * scale_);
      else
        drawHaloLine(image, pixel(p), pixel(q), color, scale_);
    }
  }

  // Bounding box of the corners in front of the camera.
  cv::Rect
  bounds() const
  {
    std::vector<cv::Point> points;
    for (int k = 0; k < 8; ++k)
      if (corners_(2, k) >= near_)
        points.emplace_back(pixel(corners_.col(k)));
    return points.empty() ? cv::Rect() : cv::boundingRect(points);
  }

private:
  static constexpr double near_ = 0.05; // [m]

  static int
  faceOf(int corner, int axis)
  {
    return 2 * axis + ((corner >> axis & 1) != 0 ? 0 : 1);
  }

  static bool
  clip(Eigen::Vector3d& p, Eigen::Vector3d& q)
  {
    if (p.z() < near_ && q.z() < near_)
      return false;
    Eigen::Vector3d& behind = p.z() < q.z() ? p : q;
    const Eigen::Vector3d& front = p.z() < q.z() ? q : p;
    if (behind.z() < near_)
      behind += (front - behind) * ((near_ - behind.z()) / (front.z() - behind.z()));
    return true;
  }

  cv::Point2f
  pixel(const Eigen::Vector3d& p) const
  {
    // far outside the picture is as good as anywhere outside, and fits an int
    constexpr double limit = 30000;
    const Eigen::Vector2d uv =
        (scale_ * (camera_.project(p) + Eigen::Vector2d(0.5, 0.5)))
            .cwiseMax(-limit)
            .cwiseMin(limit);
    return {static_cast<float>(uv.x()), static_cast<float>(uv.y())};
  }

  Eigen::Matrix<double, 3, 8> corners_;
  const Intrinsics& camera_;
  int scale_;
  bool front_[6] = {};
};

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
    legend.push_back({"colour edge", color_edge, LegendMark::square});
  if (anyOf(contents.edges, EDGE_OCCLUSION))
    legend.push_back({"occlusion edge", occlusion_edge, LegendMark::square});
  if (anyOf(contents.edges, EDGE_CREASE))
    legend.push_back({"crease edge", crease_edge, LegendMark::square});
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
  const int scale = std::max(1, (min_columns + images.width() - 1) / images.width());
  const int text_scale = std::max(1, images.width() * scale / 1280);
  cv::Mat3b image = background(images, scale);
  if (!contents.edges.empty())
    drawEdges(image, contents.edges, scale);

  const auto at = [&](const Eigen::Vector2f& pixel) {
    return cv::Point2f(scale * (pixel.x() + 0.5f), scale * (pixel.y() + 0.5f));
  };
  for (const LineSegment& s : contents.segments)
    drawThinLine(image, at(s.pixels[0]), at(s.pixels[1]), segment_color);
  for (const Vertex& v : contents.vertices)
    if (v.point.z() > 0 && images.intrinsics.valid())
      cv::circle(image,
                 at(images.intrinsics.project(v.point).cast<float>()),
                 4 * text_scale,
                 vertex_color,
                 text_scale,
                 cv::LINE_AA);

  const std::vector<RecognizedCuboid>& cuboids = contents.result.cuboids;
  if (images.intrinsics.valid()) {
    std::vector<Wireframe> wireframes;
    for (const RecognizedCuboid& recognized : cuboids)
      wireframes.emplace_back(recognized.cuboid, images.intrinsics, scale);
    constexpr std::size_t colors = sizeof palette / sizeof *palette;
    // all hidden edges lie under all visible ones, and the best cuboid on top
    for (std::size_t i = cuboids.size(); i-- > 0;) {
      wireframes[i].fill(image, palette[i % colors]);
      wireframes[i].draw(image, palette[i % colors], true);
    }
    for (std::size_t i = cuboids.size(); i-- > 0;)
      wireframes[i].draw(image, palette[i % colors], false);
    LabelPlacer labels(image.size(), text_scale);
    for (std::size_t i = 0; i < cuboids.size(); ++i)
      labels.add(labelText(cuboids[i], i), wireframes[i].bounds(), palette[i % colors]);
    labels.draw(image);
  }

  cv::Mat3b picture;
  cv::vconcat(image, footer(contents, image.cols, text_scale), picture);
  return picture;
}

} // namespace hoist
