#include <hoist/segmentation/vertex_models.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <pcl/exceptions.h>

#include <algorithm>
#include <cmath>

namespace hoist {
namespace {

// The vertex of every segment end, -1 where it has none.
using VertexTable = std::vector<std::array<int, 2>>;

VertexTable
vertexTable(const std::vector<LineSegment>& segments,
            const std::vector<Vertex>& vertices)
{
  VertexTable table(segments.size(), {-1, -1});
  for (std::size_t i = 0; i < vertices.size(); ++i)
    for (const SegmentEnd& end : vertices[i].ends)
      table[end.segment][end.end] = static_cast<int>(i);
  return table;
}

// The ends of one vertex whose segments leave it, one per segment.
std::vector<SegmentEnd>
leavingEnds(const Vertex& vertex, const VertexTable& table, Diagnostics& diagnostics)
{
  std::vector<SegmentEnd> out;
  for (const SegmentEnd& end : vertex.ends) {
    const auto& of = table[end.segment];
    if (of[0] != of[1])
      out.push_back(end);
    else if (end.end == 0)
      diagnostics.rejected.add("segment within one vertex");
  }
  return out;
}

// Edge as a vector away from the end.
Eigen::Vector3d
edgeFrom(const std::vector<LineSegment>& segments, const SegmentEnd& end)
{
  const Eigen::Vector3d delta = segments[end.segment].delta();
  return end.end == 0 ? delta : Eigen::Vector3d(-delta);
}

const Eigen::Vector3d&
pointOf(const std::vector<LineSegment>& segments, const SegmentEnd& end)
{
  return segments[end.segment].points[end.end];
}

double
supportOf(const LineSegment& segment)
{
  const Eigen::Vector2f run = (segment.pixels[1] - segment.pixels[0]).cwiseAbs();
  // a raster line has one pixel per step of its longer axis
  const double steps = std::round(run.maxCoeff()) + 1.0;
  return std::min(1.0, static_cast<double>(segment.indices.size()) / steps);
}

// Everything that models I and II share, from the three edges and the corner they
// start at (model II: as if moved there).
bool
makeCuboid(const std::vector<LineSegment>& segments,
           const std::array<SegmentEnd, 3>& ends,
           const std::array<Eigen::Vector3d, 3>& edges,
           const std::array<bool, 3>& closed,
           const Eigen::Vector3d& corner,
           Cuboid& cuboid)
{
  Eigen::Matrix3d directions;
  double score = 0;
  cuboid.indices.clear();
  for (int k = 0; k < 3; ++k) {
    const LineSegment& segment = segments[ends[k].segment];
    cuboid.size[k] = edges[k].norm(); // Table 2's E
    directions.col(k) = edges[k] / cuboid.size[k];
    cuboid.dimension_source[k] =
        closed[k] ? DimensionSource::measured : DimensionSource::partial;
    score += supportOf(segment) * (closed[k] ? 1.0 : 0.5) / 3;
    cuboid.segments.push_back(ends[k].segment);
    cuboid.indices.insert(
        cuboid.indices.end(), segment.indices.begin(), segment.indices.end());
  }
  if (!(cuboid.size.minCoeff() > 0) || !directions.allFinite())
    return false;
  std::sort(cuboid.indices.begin(), cuboid.indices.end());
  cuboid.indices.erase(std::unique(cuboid.indices.begin(), cuboid.indices.end()),
                       cuboid.indices.end());

  // 4.3: the centroid by the triangle rule
  cuboid.center = corner + 0.5 * (edges[0] + edges[1] + edges[2]);
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(
      directions, Eigen::ComputeFullU | Eigen::ComputeFullV);
  cuboid.axes = svd.matrixU() * svd.matrixV().transpose();
  double cosine = 0;
  for (int k = 0; k < 3; ++k)
    cosine =
        std::max(cosine, std::abs(directions.col(k).dot(directions.col((k + 1) % 3))));
  cuboid.score = std::clamp((1 - cosine) * score, 0.0, 1.0);
  return true;
}

// A face is observed where two of the three edges span it and it faces the camera.
// Edges start on the negative side of their axes.
void
observeFace(Cuboid& cuboid, int axis)
{
  const Eigen::Vector3d normal = -cuboid.axes.col(axis);
  const Eigen::Vector3d at = cuboid.center + 0.5 * cuboid.size[axis] * normal;
  cuboid.observed_faces[2 * axis + 1] = normal.dot(at) < 0;
}

void
count(std::size_t hypotheses,
      std::size_t oblique,
      const char* reason,
      Diagnostics& diagnostics)
{
  diagnostics.counts.add("hypotheses", hypotheses);
  if (oblique > 0)
    diagnostics.rejected.add(reason, oblique);
}

void
makeRightHanded(Cuboid& cuboid)
{
  if (cuboid.axes.determinant() > 0)
    return;
  cuboid.axes.col(2) *= -1;
  std::swap(cuboid.observed_faces[4], cuboid.observed_faces[5]);
}

} // namespace

void
VertexModels::setTolerance(double tolerance)
{
  if (!(tolerance >= 0) || !std::isfinite(tolerance))
    PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                        "hoist::VertexModels: the tolerance must be finite and >= 0");
  tolerance_ = tolerance;
}

void
VertexModels::setMaxDegree(int degree)
{
  if (degree < 3)
    PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                        "hoist::VertexModels: the largest degree must be >= 3");
  max_degree_ = degree;
}

bool
VertexModels::perpendicular(const LineSegment& a, const LineSegment& b) const
{
  const Eigen::Vector3d di = normalized_ ? a.direction() : a.delta();
  const Eigen::Vector3d dj = normalized_ ? b.direction() : b.delta();
  // Equation (2), the exact condition, is this sum being 0
  const double dot = di.x() * dj.x() + di.y() * dj.y() + di.z() * dj.z();
  return std::abs(dot) <= tolerance_; // Equation (3)
}

void
VertexModels::findModelOne(const std::vector<LineSegment>& segments,
                           const std::vector<Vertex>& vertices,
                           std::vector<Cuboid>& cuboids,
                           Diagnostics& diagnostics) const
{
  const VertexTable table = vertexTable(segments, vertices);
  std::size_t hypotheses = 0, oblique = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (vertices[i].aggregationDegree() < 3)
      continue;
    const std::vector<SegmentEnd> ends = leavingEnds(vertices[i], table, diagnostics);
    if (static_cast<int>(ends.size()) > max_degree_) {
      diagnostics.rejected.add("vertex of too many segments");
      continue;
    }
    const auto right = [&](std::size_t a, std::size_t b) {
      return perpendicular(segments[ends[a].segment], segments[ends[b].segment]);
    };
    for (std::size_t a = 0; a < ends.size(); ++a)
      for (std::size_t b = a + 1; b < ends.size(); ++b) {
        const std::size_t triples = ends.size() - b - 1;
        hypotheses += triples;
        if (!right(a, b)) {
          oblique += triples;
          continue;
        }
        for (std::size_t c = b + 1; c < ends.size(); ++c) {
          if (!right(a, c) || !right(b, c)) {
            ++oblique;
            continue;
          }
          const std::array<SegmentEnd, 3> triple = {ends[a], ends[b], ends[c]};
          std::array<Eigen::Vector3d, 3> edges;
          std::array<bool, 3> closed{};
          Eigen::Vector3d corner = Eigen::Vector3d::Zero();
          Cuboid cuboid;
          cuboid.model = CuboidModel::vertex_one;
          cuboid.vertices.push_back(static_cast<int>(i));
          for (int k = 0; k < 3; ++k) {
            edges[k] = edgeFrom(segments, triple[k]);
            corner += pointOf(segments, triple[k]) / 3;
            closed[k] = table[triple[k].segment][1 - triple[k].end] >= 0;
          }
          if (!makeCuboid(segments, triple, edges, closed, corner, cuboid)) {
            diagnostics.rejected.add("model I: no volume");
            continue;
          }
          for (int axis = 0; axis < 3; ++axis)
            observeFace(cuboid, axis);
          makeRightHanded(cuboid);
          canonicalize(cuboid);
          cuboids.push_back(std::move(cuboid));
        }
      }
  }
  count(hypotheses, oblique, "model I: not perpendicular", diagnostics);
}

void
VertexModels::findModelTwo(const std::vector<LineSegment>& segments,
                           const std::vector<Vertex>& vertices,
                           std::vector<Cuboid>& cuboids,
                           Diagnostics& diagnostics) const
{
  const VertexTable table = vertexTable(segments, vertices);
  std::vector<std::vector<SegmentEnd>> leaving;
  leaving.reserve(vertices.size());
  // counted by model I already
  Diagnostics ignored;
  for (const Vertex& vertex : vertices)
    leaving.push_back(leavingEnds(vertex, table, ignored));

  std::size_t hypotheses = 0, oblique = 0;
  for (std::size_t m = 0; m < segments.size(); ++m) {
    const int first = table[m][0], second = table[m][1];
    if (first < 0 || second < 0 || first == second)
      continue;
    if (static_cast<int>(leaving[first].size()) > max_degree_ ||
        static_cast<int>(leaving[second].size()) > max_degree_)
      continue;
    const int middle = static_cast<int>(m);
    for (const SegmentEnd& p : leaving[first])
      for (const SegmentEnd& q : leaving[second]) {
        if (p.segment == middle || q.segment == middle || p.segment == q.segment)
          continue;
        ++hypotheses;
        if (!perpendicular(segments[m], segments[p.segment]) ||
            !perpendicular(segments[m], segments[q.segment]) ||
            !perpendicular(segments[p.segment], segments[q.segment])) {
          ++oblique;
          continue;
        }
        const std::array<SegmentEnd, 3> triple = {SegmentEnd{middle, 0}, p, q};
        const std::array<Eigen::Vector3d, 3> edges = {edgeFrom(segments, triple[0]),
                                                      edgeFrom(segments, p),
                                                      edgeFrom(segments, q)};
        const std::array<bool, 3> closed = {
            true, table[p.segment][1 - p.end] >= 0, table[q.segment][1 - q.end] >= 0};
        // the middle of the middle edge is seen from both vertices; half of it back is
        // the corner at which the first vertex lies
        const Eigen::Vector3d corner =
            0.25 * (segments[m].points[0] + pointOf(segments, p) +
                    segments[m].points[1] + pointOf(segments, q)) -
            0.5 * edges[0];
        Cuboid cuboid;
        cuboid.model = CuboidModel::vertex_two;
        cuboid.vertices = {first, second};
        if (!makeCuboid(segments, triple, edges, closed, corner, cuboid)) {
          diagnostics.rejected.add("model II: no volume");
          continue;
        }
        observeFace(cuboid, 1); // spanned by the middle segment and q
        observeFace(cuboid, 2); // spanned by the middle segment and p
        makeRightHanded(cuboid);
        canonicalize(cuboid);
        cuboids.push_back(std::move(cuboid));
      }
  }
  count(hypotheses, oblique, "model II: not perpendicular", diagnostics);
}

void
VertexModels::find(const std::vector<LineSegment>& segments,
                   const std::vector<Vertex>& vertices,
                   std::vector<Cuboid>& cuboids,
                   Diagnostics& diagnostics) const
{
  cuboids.clear();
  findModelOne(segments, vertices, cuboids, diagnostics);
  findModelTwo(segments, vertices, cuboids, diagnostics);
}

std::size_t
keepBestOfEachBox(std::vector<Cuboid>& cuboids)
{
  const auto holds = [](const Cuboid& box, const Eigen::Vector3d& point) {
    const Eigen::Vector3d local = box.axes.transpose() * (point - box.center);
    return (local.cwiseAbs().array() <= 0.5 * box.size.array()).all();
  };
  std::stable_sort(cuboids.begin(),
                   cuboids.end(),
                   [](const Cuboid& a, const Cuboid& b) { return a.score > b.score; });
  std::vector<Cuboid> kept;
  for (Cuboid& cuboid : cuboids)
    if (std::none_of(kept.begin(), kept.end(), [&](const Cuboid& better) {
          return holds(better, cuboid.center) || holds(cuboid, better.center);
        }))
      kept.push_back(std::move(cuboid));
  const std::size_t removed = cuboids.size() - kept.size();
  cuboids.swap(kept);
  return removed;
}

} // namespace hoist
