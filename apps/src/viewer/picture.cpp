#include "viewer/picture.h"

#include "background.h"
#include "cuboid_drawing.h"
#include "drawing.h"
#include "labels.h"
#include "palette.h"
#include "wireframe.h"

#include <hoist/filters/edge_kind.h>

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace hoist {
namespace {

class Painter {
public:
  Painter(const Scene& scene, const LayerSet& layers, const Highlight& highlight)
  : scene_(scene)
  , images_(*scene.frame->images)
  , layers_(layers)
  , highlight_(highlight)
  , scale_(pictureScale(scene))
  , text_scale_(2 * textScaleOf(images_.width() * scale_)) // it is seen smaller
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
      boxes(Layer::rejected, rejectedBoxes(), highlight_.rejection);
      boxes(Layer::truth, trueBoxes(), -1);
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
  boxes(Layer layer, const std::vector<Cuboid>& cuboids, int strong)
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
                       static_cast<int>(i) == strong ? scale_ + 1
                                                     : std::max(1, scale_ / 2),
                       3 * scale_);
  }

  void
  cuboids()
  {
    const std::vector<Cuboid> cuboids = cuboidsOf(scene_);
    const Wireframes wireframes(cuboids, images_, scale_);
    const cv::Mat1i owners = wireframes.owners(picture_.size());
    constexpr double strong = 0.28; // a layer of its own may cover the picture
    if (layers_.shows(Layer::faces))
      tintCuboids(picture_, owners, strong);
    if (!layers_.shows(Layer::cuboids))
      return;
    std::vector<std::vector<EdgePiece>> edges;
    std::vector<int> thickness(cuboids.size(), scale_ + 1);
    for (std::size_t i = 0; i < cuboids.size(); ++i)
      edges.push_back(wireframes.edges(i));
    if (highlight_.cuboid >= 0)
      thickness.at(static_cast<std::size_t>(highlight_.cuboid)) = 2 * scale_ + 1;
    drawCuboidEdges(picture_, edges, scale_, thickness);
    if (!highlight_.labels)
      return;
    LabelPlacer placer(owners, text_scale_);
    for (std::size_t i = 0; i < cuboids.size(); ++i)
      placer.add({numberAndSizes(cuboids[i], i)}, static_cast<int>(i), cuboidColor(i));
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
  const Highlight& highlight_;
  int scale_;
  int text_scale_;
  cv::Mat3b picture_;
};

} // namespace

int
pictureScale(const Scene& scene)
{
  return scene.frame ? enlargement(scene.frame->images->width()) : 1;
}

cv::Mat3b
drawPicture(const Scene& scene, const LayerSet& layers, const Highlight& highlight)
{
  if (!scene.frame) {
    cv::Mat3b picture(720, 960, cv::Vec3b(24, 24, 24));
    drawText(picture, "no picture", {400, 360}, 2);
    return picture;
  }
  return Painter(scene, layers, highlight).paint();
}

} // namespace hoist
