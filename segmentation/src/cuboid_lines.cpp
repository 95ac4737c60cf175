#include <hoist/segmentation/cuboid_lines.h>
#include <hoist/segmentation/extract_line_segments.h>

#include <algorithm>

namespace hoist {
namespace {

double
distanceToEdge(const Eigen::Vector3d& p,
               const Eigen::Vector3d& a,
               const Eigen::Vector3d& b)
{
  const Eigen::Vector3d run = b - a;
  const double t = std::clamp((p - a).dot(run) / run.squaredNorm(), 0.0, 1.0);
  return (a + t * run - p).norm();
}

} // namespace

void
attachLines(const std::vector<LineSegment>& segments,
            const std::vector<Vertex>& vertices,
            double distance,
            std::vector<Cuboid>& cuboids)
{
  for (Cuboid& cuboid : cuboids) {
    cuboid.segments.clear();
    cuboid.vertices.clear();
    const auto corners = cuboid.corners();
    const auto& edges = Cuboid::edges();
    for (std::size_t i = 0; i < segments.size(); ++i)
      if (std::any_of(edges.begin(), edges.end(), [&](const std::array<int, 2>& edge) {
            const Eigen::Vector3d a = corners.col(edge[0]), b = corners.col(edge[1]);
            return distanceToEdge(segments[i].points[0], a, b) <= distance &&
                   distanceToEdge(segments[i].points[1], a, b) <= distance;
          }))
        cuboid.segments.push_back(static_cast<int>(i));
    for (std::size_t i = 0; i < vertices.size(); ++i)
      if ((corners.colwise() - vertices[i].point).colwise().norm().minCoeff() <=
          distance)
        cuboid.vertices.push_back(static_cast<int>(i));
  }
}

void
CuboidLines::find(const FrameImages& images,
                  const cv::Mat1b& mask,
                  const SensorModel& sensor,
                  cv::Mat1b& edges,
                  std::vector<LineSegment>& segments,
                  std::vector<Vertex>& vertices,
                  Diagnostics& diagnostics)
{
  EdgeParameters parameters;
  parameters.depth.sensor = sensor;
  detector_.detect(images, parameters, labels_);
  edges.create(labels_.size());
  edges.setTo(0);
  if (mask.empty())
    edges.setTo(255, labels_);
  else
    edges.setTo(255, (labels_ != 0) & (mask != 0));
  diagnostics.counts.add("edge pixels",
                         static_cast<std::size_t>(cv::countNonZero(edges)));
  LineExtractionParameters lines;
  lines.sensor = sensor;
  extractLineSegments(images, edges, lines, segments, diagnostics);
  clustering_.cluster(segments, vertices);
  diagnostics.counts.add("vertices", vertices.size());
}

} // namespace hoist
