#include "viewer/picture.h"

#include "background.h"
#include "drawing.h"
#include "labels.h"
#include "palette.h"
#include "size_text.h"
#include "wireframe.h"

#include <hoist/filters/edge_kind.h>

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace hoist {
namespace {

constexpr int min_columns = 1280;

class Painter {
public:
  Painter(const Scene& scene, const LayerSet& layers, int selected, bool labels)
  : scene_(scene)
  , images_(*scene.frame->images)
  , layers_(layers)
  , selected_(selected)
  , labels_(labels)
  , scale_(pictureScale(scene))
  , text_scale_(2 * std::max(1, images_.width() * scale_ / min_columns))
  {
  }

  cv::Mat3b
  paint()
  {
    picture_ = layers_.shows(Layer::cloud) ? background(images_, scale_)
                                           : cv::Mat3b(images_.height() * scale_,
                                                       images_.width() * scale_,
                                                       cv::Vec3b(24, 24, 24));
    edges(Layer::color_edges, EDGE_COLOR);
    edges(Layer::crease_edges, EDGE_CREASE);
    edges(Layer::occlusion_edges, EDGE_OCCLUSION);
    segments();
    vertices();
    if (images_.intrinsics.valid()) {
      boxes(Layer::rejected, rejectedBoxes());
      boxes(Layer::truth, trueBoxes());
      cuboids();
    }
    detections();
    return picture_;
  }

private:
  cv::Point2f
  at(double u, double v) const
  {
    return {static_cast<float>(scale_ * (u + 0.5)),
            static_cast<float>(scale_ * (v + 0.5))};
  }

  void
  edges(Layer layer, int kind)
  {
    if (!layers_.shows(layer))
      return;
    const cv::Scalar& color = infoOf(layer).color;
    for (int v = 0; v < scene_.edges.rows; ++v)
      for (int u = 0; u < scene_.edges.cols; ++u)
        if ((scene_.edges(v, u) & kind) != 0)
          picture_(cv::Rect(u * scale_, v * scale_, scale_, scale_)).setTo(color);
  }

  void
  segments()
  {
    if (!layers_.shows(Layer::segments))
      return;
    for (const LineSegment& s : scene_.segments)
      cv::line(picture_,
               at(s.pixels[0].x(), s.pixels[0].y()),
               at(s.pixels[1].x(), s.pixels[1].y()),
               infoOf(Layer::segments).color,
               scale_,
               cv::LINE_AA);
  }

  void
  vertices()
  {
    if (!layers_.shows(Layer::vertices) || !images_.intrinsics.valid())
      return;
    for (const Vertex& v : scene_.vertices)
      if (v.point.z() > 0) {
        const Eigen::Vector2d uv = images_.intrinsics.project(v.point);
        cv::circle(picture_,
                   at(uv.x(), uv.y()),
                   scale_ * (1 + std::min(v.aggregationDegree(), 8)),
                   infoOf(Layer::vertices).color,
                   scale_,
                   cv::LINE_AA);
      }
  }

  std::vector<Cuboid>
  rejectedBoxes() const
  {
    std::vector<Cuboid> boxes;
    for (const CuboidVerdict& verdict : shownRejections(scene_))
      boxes.push_back(verdict.cuboid);
    return boxes;
  }

  std::vector<Cuboid>
  trueBoxes() const
  {
    return scene_.truth ? trueCuboids(*scene_.truth) : std::vector<Cuboid>();
  }

  // Boxes beside the results: thin, of one colour.
  void
  boxes(Layer layer, const std::vector<Cuboid>& cuboids)
  {
    if (!layers_.shows(layer))
      return;
    const Wireframes wireframes(cuboids, images_, scale_);
    for (std::size_t i = 0; i < cuboids.size(); ++i)
      for (const EdgePiece& piece : wireframes.edges(i))
        drawDashedLine(picture_,
                       piece.from,
                       piece.to,
                       infoOf(layer).color,
                       std::max(1, scale_ / 2),
                       3 * scale_);
  }

  void
  cuboids()
  {
    std::vector<Cuboid> cuboids;
    for (const RecognizedCuboid& recognized : scene_.result.cuboids)
      cuboids.push_back(recognized.cuboid);
    const Wireframes wireframes(cuboids, images_, scale_);
    const cv::Mat1i owners = wireframes.owners(picture_.size());
    if (layers_.shows(Layer::faces))
      for (int y = 0; y < picture_.rows; ++y)
        for (int x = 0; x < picture_.cols; ++x)
          if (const int i = owners(y, x); i >= 0) {
            const cv::Scalar color = cuboidColor(static_cast<std::size_t>(i));
            for (int c = 0; c < 3; ++c)
              picture_(y, x)[c] = cv::saturate_cast<unsigned char>(
                  0.72 * picture_(y, x)[c] + 0.28 * color[c]);
          }
    if (!layers_.shows(Layer::cuboids))
      return;
    for (const bool hidden : {true, false})
      for (std::size_t i = 0; i < cuboids.size(); ++i)
        for (const EdgePiece& piece : wireframes.edges(i))
          if (piece.hidden == hidden) {
            const bool strong = static_cast<int>(i) == selected_;
            if (hidden)
              drawDashedLine(
                  picture_, piece.from, piece.to, cuboidColor(i), 1, 4 * scale_);
            else
              drawHaloLine(picture_,
                           piece.from,
                           piece.to,
                           cuboidColor(i),
                           strong ? 2 * scale_ + 1 : scale_ + 1);
          }
    if (!labels_)
      return;
    LabelPlacer placer(owners, text_scale_);
    for (std::size_t i = 0; i < cuboids.size(); ++i)
      placer.add({"#" + std::to_string(i + 1) + "  " + sizeText(cuboids[i], 0) + " x " +
                  sizeText(cuboids[i], 1) + " x " + sizeText(cuboids[i], 2) + " cm"},
                 static_cast<int>(i),
                 cuboidColor(i));
    placer.draw(picture_);
  }

  void
  detections()
  {
    if (!layers_.shows(Layer::detections))
      return;
    const cv::Scalar& color = infoOf(Layer::detections).color;
    for (const Detection& d : scene_.detections) {
      const cv::Point2f corner = at(d.box.x - 0.5, d.box.y - 0.5);
      cv::rectangle(picture_,
                    corner,
                    at(d.box.br().x - 0.5, d.box.br().y - 0.5),
                    color,
                    scale_,
                    cv::LINE_AA);
      std::string text = d.label;
      if (!std::isnan(d.score))
        text += cv::format(text.empty() ? "%.2f" : " %.2f", d.score);
      drawText(picture_,
               text,
               cv::Point(corner) + cv::Point(2 * scale_, -3 * scale_),
               text_scale_);
    }
  }

  const Scene& scene_;
  const FrameImages& images_;
  const LayerSet& layers_;
  int selected_;
  bool labels_;
  int scale_;
  int text_scale_;
  cv::Mat3b picture_;
};

} // namespace

int
pictureScale(const Scene& scene)
{
  if (!scene.frame)
    return 1;
  const int width = std::max(1, scene.frame->images->width());
  return std::max(1, (min_columns + width - 1) / width);
}

cv::Mat3b
drawPicture(const Scene& scene, const LayerSet& layers, int selected, bool labels)
{
  if (!scene.frame) {
    cv::Mat3b picture(720, 960, cv::Vec3b(24, 24, 24));
    drawText(picture, "no picture", {400, 360}, 2);
    return picture;
  }
  return Painter(scene, layers, selected, labels).paint();
}

} // namespace hoist
