#include "viewer/scene_layers.h"

#include "palette.h"
#include "size_text.h"
#include "viewer/shapes.h"

#include <hoist/filters/edge_kind.h>

#include <vtkActor.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>

namespace hoist {
namespace {

using Line = std::pair<Eigen::Vector3d, Eigen::Vector3d>;

std::vector<Line>
edgesOf(const Cuboid& cuboid, const Eigen::Isometry3d& pose)
{
  const Eigen::Matrix<double, 3, 8> corners = cuboid.corners();
  std::vector<Line> lines;
  for (const auto& edge : Cuboid::edges())
    lines.emplace_back(pose * corners.col(edge[0]), pose * corners.col(edge[1]));
  return lines;
}

// The corner that is nearest to the sensor; its three edges are seen.
int
nearCorner(const Cuboid& cuboid)
{
  int nearest = 0;
  cuboid.corners().colwise().norm().minCoeff(&nearest);
  return nearest;
}

// The median depth of the points of a part of the frame; 0 if there are none.
double
medianDepth(const FrameImages& images, const cv::Rect& part)
{
  std::vector<float> values;
  for (const float w : images.inverse_depth(part))
    if (w > 0)
      values.push_back(w);
  if (values.empty())
    return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return 1.0 / *middle;
}

} // namespace

SceneLayers::SceneLayers(vtkRenderer* among_points, vtkRenderer* above)
: among_points_(among_points), above_(above), cuboids_(above)
{
}

SceneLayers::~SceneLayers()
{
  clear();
}

void
SceneLayers::clear()
{
  for (const vtkSmartPointer<vtkProp>& prop : props_) {
    among_points_->RemoveViewProp(prop);
    above_->RemoveViewProp(prop);
  }
  props_.clear();
  cuboids_.clear();
}

void
SceneLayers::addAmongPoints(const vtkSmartPointer<vtkProp>& prop)
{
  prop->PickableOff();
  among_points_->AddViewProp(prop);
  props_.push_back(prop);
}

void
SceneLayers::addAbove(const vtkSmartPointer<vtkProp>& prop)
{
  prop->PickableOff();
  above_->AddViewProp(prop);
  props_.push_back(prop);
}

void
SceneLayers::show(const Scene& scene,
                  const LayerSet& layers,
                  const Highlight& highlight)
{
  clear();
  if (!scene.hasFrame())
    return;
  addEdges(scene, layers);
  if (layers.shows(Layer::segments))
    addSegments(scene);
  if (layers.shows(Layer::vertices))
    addVertices(scene);
  if (layers.shows(Layer::faces))
    addFaces(scene);
  if (layers.shows(Layer::rejected))
    addRejected(scene, highlight.rejection);
  if (layers.shows(Layer::truth) && scene.truth)
    addTruth(scene);
  if (layers.shows(Layer::cuboids))
    addCuboids(scene, highlight);
  if (layers.shows(Layer::uncertainty))
    addUncertainty(scene);
  if (layers.shows(Layer::detections))
    addDetections(scene);
}

void
SceneLayers::addEdges(const Scene& scene, const LayerSet& layers)
{
  const Eigen::Isometry3d pose = scene.pose();
  const std::array<std::pair<Layer, int>, 3> kinds = {
      {{Layer::color_edges, EDGE_COLOR},
       {Layer::crease_edges, EDGE_CREASE},
       {Layer::occlusion_edges, EDGE_OCCLUSION}}};
  const cv::Mat3f& points = scene.frame->images->points;
  for (const auto& [layer, kind] : kinds) {
    if (!layers.shows(layer))
      continue;
    std::vector<Eigen::Vector3d> found;
    for (int v = 0; v < scene.edges.rows; ++v)
      for (int u = 0; u < scene.edges.cols; ++u)
        if ((scene.edges(v, u) & kind) != 0 &&
            scene.frame->images->inverse_depth(v, u) > 0) {
          const cv::Vec3f& p = points(v, u);
          found.emplace_back(pose * Eigen::Vector3d(p[0], p[1], p[2]));
        }
    addAbove(pointsActor(found, infoOf(layer).color, 2.5F));
  }
}

void
SceneLayers::addSegments(const Scene& scene)
{
  std::vector<Line> lines;
  for (const LineSegment& s : scene.segments)
    lines.emplace_back(scene.pose() * s.points[0], scene.pose() * s.points[1]);
  addAbove(linesActor(lines, infoOf(Layer::segments).color, 2.0F, 1.0));
}

void
SceneLayers::addVertices(const Scene& scene)
{
  std::map<int, std::vector<Eigen::Vector3d>> by_degree;
  for (const Vertex& v : scene.vertices)
    by_degree[std::min(v.aggregationDegree(), 8)].emplace_back(scene.pose() * v.point);
  for (const auto& [degree, points] : by_degree)
    addAbove(pointsActor(points,
                         infoOf(Layer::vertices).color,
                         2.0F + 2.0F * static_cast<float>(degree)));
}

void
SceneLayers::addCuboids(const Scene& scene, const Highlight& highlight)
{
  const Eigen::Isometry3d pose = scene.pose();
  for (std::size_t i = 0; i < scene.result.cuboids.size(); ++i) {
    const Cuboid& cuboid = scene.result.cuboids[i].cuboid;
    const cv::Scalar color = cuboidColor(i);
    const bool strong = static_cast<int>(i) == highlight.cuboid;
    const Eigen::Matrix<double, 3, 8> corners = cuboid.corners();
    // dashes of a few pixels, seen from the sensor
    const double dash = 0.006 * cuboid.center.norm();
    cuboids_.add((pose * corners.colwise().homogeneous()).eval(),
                 color,
                 strong ? 5.0F : 3.0F,
                 dash);
    if (!highlight.labels)
      continue;
    // each size stands on the edge that it measures, in front
    const int near = nearCorner(cuboid);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d middle =
          0.5 * (corners.col(near) + corners.col(near ^ (1 << axis)));
      addAbove(labelActor(sizeText(cuboid, axis), pose * middle, color, 14));
    }
    addAbove(labelActor(
        "#" + std::to_string(i + 1), pose * cuboid.center, color, strong ? 20 : 16));
  }
}

void
SceneLayers::addFaces(const Scene& scene)
{
  for (std::size_t i = 0; i < scene.result.cuboids.size(); ++i) {
    const Cuboid& cuboid = scene.result.cuboids[i].cuboid;
    const Eigen::Matrix<double, 3, 8> corners = cuboid.corners();
    std::vector<std::array<Eigen::Vector3d, 4>> quads;
    for (int face = 0; face < 6; ++face) {
      if (!cuboid.observed_faces[static_cast<std::size_t>(face)])
        continue;
      const int axis = face / 2, side = face % 2 == 0 ? 1 << axis : 0;
      const int a = 1 << ((axis + 1) % 3), b = 1 << ((axis + 2) % 3);
      // a little outside, so that the surface's own points do not cover it
      const Eigen::Vector3d out =
          (face % 2 == 0 ? 0.002 : -0.002) * cuboid.axes.col(axis);
      std::array<Eigen::Vector3d, 4> quad;
      const std::array<int, 4> ring = {side, side | a, side | a | b, side | b};
      for (std::size_t k = 0; k < 4; ++k)
        quad[k] = scene.pose() * (corners.col(ring[k]) + out);
      quads.push_back(quad);
    }
    addAmongPoints(quadsActor(quads, cuboidColor(i), 0.35));
  }
}

void
SceneLayers::addUncertainty(const Scene& scene)
{
  constexpr double enlarged = 30.0; // 3 sigma, ten times: sigmas are a millimetre
  for (const RecognizedCuboid& recognized : scene.result.cuboids) {
    const Eigen::Vector3d sigma = recognized.cuboid.center_sigma;
    if (!sigma.allFinite())
      continue;
    const Eigen::Matrix3d axes = scene.pose().linear();
    addAbove(ellipsoidActor(scene.pose() * recognized.cuboid.center,
                            axes * (enlarged * sigma).asDiagonal(),
                            infoOf(Layer::uncertainty).color));
  }
}

void
SceneLayers::addRejected(const Scene& scene, int selected)
{
  std::vector<Line> lines;
  int number = 0;
  const cv::Scalar& color = infoOf(Layer::rejected).color;
  std::set<std::string> named;
  for (const CuboidVerdict& verdict : shownRejections(scene)) {
    const std::vector<Line> edges = edgesOf(verdict.cuboid, scene.pose());
    lines.insert(lines.end(), edges.begin(), edges.end());
    const bool strong = number++ == selected;
    if (strong)
      addAbove(linesActor(edges, color, 4.0F, 1.0));
    // Once for each reason; the card of any box tells its own. Most boxes are about the
    // same place, so the words go above and below each other: 0, 1, -1, 2, -2 rows.
    const auto n = static_cast<int>(named.size());
    constexpr int row = 18; // [px]
    const int lift = strong ? 0 : (n % 2 == 0 ? -n / 2 : (n + 1) / 2) * row;
    if (named.insert(verdict.rejected).second || strong)
      addAbove(labelActor(
          verdict.rejected, scene.pose() * verdict.cuboid.center, color, 12, lift));
  }
  addAbove(linesActor(lines, color, 1.0F, 0.8));
}

void
SceneLayers::addDetections(const Scene& scene)
{
  const FrameImages& images = *scene.frame->images;
  if (!images.intrinsics.valid())
    return;
  std::vector<Line> lines;
  const cv::Scalar& color = infoOf(Layer::detections).color;
  for (const Detection& d : scene.detections) {
    const cv::Rect part = cv::Rect(d.box) & cv::Rect({}, images.points.size());
    const double z = part.empty() ? 0 : medianDepth(images, part);
    if (z <= 0)
      continue;
    const auto corner = [&](double u, double v) -> Eigen::Vector3d {
      return scene.pose() * (z * images.intrinsics.ray(u - 0.5, v - 0.5));
    };
    const std::array<Eigen::Vector3d, 4> ring = {corner(d.box.x, d.box.y),
                                                 corner(d.box.br().x, d.box.y),
                                                 corner(d.box.br().x, d.box.br().y),
                                                 corner(d.box.x, d.box.br().y)};
    for (std::size_t i = 0; i < 4; ++i)
      lines.emplace_back(ring[i], ring[(i + 1) % 4]);
    if (!d.label.empty())
      addAbove(labelActor(d.label, ring[0], color, 14));
  }
  addAbove(linesActor(lines, color, 2.0F, 1.0));
}

void
SceneLayers::addTruth(const Scene& scene)
{
  std::vector<Line> lines;
  for (const Cuboid& cuboid : trueCuboids(*scene.truth)) {
    const std::vector<Line> edges = edgesOf(cuboid, scene.pose());
    lines.insert(lines.end(), edges.begin(), edges.end());
  }
  addAbove(linesActor(lines, infoOf(Layer::truth).color, 1.5F, 1.0));
}

} // namespace hoist
