#include <hoist/simulation/mesh.h>
#include <hoist/simulation/random.h>

#include <algorithm>
#include <cmath>

namespace hoist {
namespace simulation {
namespace {

// A place on the outline of a unit rounded rectangle and the turn of its normal.
struct OutlinePoint {
  double corner_x, corner_y; ///< which corner, +-1
  double cosine, sine;
};

std::vector<OutlinePoint>
outline(int segments)
{
  // both ends of every corner's arc are there, so that sides can be straight
  std::vector<OutlinePoint> points;
  const int per_corner = std::max(1, segments / 4);
  for (int quarter = 0; quarter < 4; ++quarter)
    for (int i = 0; i <= per_corner; ++i) {
      const double turn = (quarter + static_cast<double>(i) / per_corner) / 4;
      points.push_back({quarter == 0 || quarter == 3 ? 1.0 : -1.0,
                        quarter < 2 ? 1.0 : -1.0,
                        cosineOfTurns(turn),
                        sineOfTurns(turn)});
    }
  return points;
}

Eigen::Vector3d
place(const Ring& ring, const OutlinePoint& point)
{
  const double r = ring.roundness;
  return {ring.shift_x + ring.half_x * (point.corner_x * (1 - r) + r * point.cosine),
          ring.shift_y + ring.half_y * (point.corner_y * (1 - r) + r * point.sine),
          ring.z};
}

// Normal of the band between two rings at a point of the outline; zero where the band
// has no height and no width.
Eigen::Vector3d
bandNormal(const Ring& low, const Ring& high, const OutlinePoint& point)
{
  const double hx = std::max({low.half_x, high.half_x, 1e-9});
  const double hy = std::max({low.half_y, high.half_y, 1e-9});
  Eigen::Vector3d across(point.cosine / hx, point.sine / hy, 0); // of an ellipse
  across.normalize();
  const Eigen::Vector3d way = place(high, point) - place(low, point);
  const Eigen::Vector3d normal =
      across * way.z() - Eigen::Vector3d(0, 0, across.dot(way));
  const double length = normal.norm();
  return length > 1e-12 ? Eigen::Vector3d(normal / length) : Eigen::Vector3d::Zero();
}

} // namespace

Mesh
loftMesh(const std::vector<Ring>& rings, int segments)
{
  Mesh mesh;
  const std::vector<OutlinePoint> points = outline(segments);
  const auto n = static_cast<std::uint32_t>(points.size());
  const auto addRow = [&](std::size_t band, std::size_t ring) {
    // the normal at a ring without crease is the mean of the bands it joins
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const OutlinePoint& point : points) {
      Eigen::Vector3d normal = bandNormal(rings[band], rings[band + 1], point);
      const bool at_end = ring == 0 || ring + 1 == rings.size();
      if (!rings[ring].crease && !at_end) {
        const std::size_t other = ring == band ? band - 1 : band + 1;
        normal += bandNormal(rings[other], rings[other + 1], point);
      }
      if (normal.squaredNorm() > 0)
        normal.normalize();
      else
        normal = Eigen::Vector3d::UnitZ();
      mesh.vertices.push_back(place(rings[ring], point));
      mesh.normals.push_back(normal.cast<float>());
    }
    return first;
  };
  const auto add =
      [&](std::uint32_t i, std::uint32_t j, std::uint32_t k, int material) {
        const Eigen::Vector3d &a = mesh.vertices[i], &b = mesh.vertices[j],
                              &c = mesh.vertices[k];
        if ((b - a).cross(c - a).squaredNorm() > 0)
          mesh.triangles.push_back(
              {{{i, j, k}}, static_cast<std::uint16_t>(material), Mesh::no_face});
      };
  for (std::size_t band = 0; band + 1 < rings.size(); ++band) {
    const std::uint32_t low = addRow(band, band), high = addRow(band, band + 1);
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::uint32_t next = (k + 1) % n;
      add(low + k, low + next, high + next, rings[band].material);
      add(low + k, high + next, high + k, rings[band].material);
    }
  }
  return mesh;
}

Mesh
tubeMesh(const std::vector<Eigen::Vector3d>& points,
         const std::vector<double>& radius,
         int segments,
         int material)
{
  Mesh mesh;
  if (points.size() < 2)
    return mesh;
  const auto tangent = [&](std::size_t i) -> Eigen::Vector3d {
    const std::size_t from = i == 0 ? 0 : i - 1;
    const std::size_t to = std::min(i + 1, points.size() - 1);
    const Eigen::Vector3d way = points[to] - points[from];
    return way.squaredNorm() > 0 ? Eigen::Vector3d(way.normalized())
                                 : Eigen::Vector3d(Eigen::Vector3d::UnitZ());
  };
  const auto n = static_cast<std::uint32_t>(std::max(3, segments));
  Eigen::Vector3d side = tangent(0).unitOrthogonal();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d along = tangent(i);
    side -= along * along.dot(side); // carried along without twist
    if (side.squaredNorm() < 1e-12)
      side = along.unitOrthogonal();
    side.normalize();
    const Eigen::Vector3d up = along.cross(side);
    const double r = radius[std::min(i, radius.size() - 1)];
    for (std::uint32_t k = 0; k < n; ++k) {
      const double turn = static_cast<double>(k) / n;
      const Eigen::Vector3d normal =
          side * cosineOfTurns(turn) + up * sineOfTurns(turn);
      mesh.vertices.emplace_back(points[i] + r * normal);
      mesh.normals.emplace_back(normal.cast<float>());
    }
  }
  const auto add = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    mesh.triangles.push_back(
        {{{i, j, k}}, static_cast<std::uint16_t>(material), Mesh::no_face});
  };
  for (std::uint32_t i = 0; i + 1 < points.size(); ++i)
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::uint32_t a = i * n + k, b = i * n + (k + 1) % n;
      add(a, b, b + n);
      add(a, b + n, a + n);
    }
  const auto last = static_cast<std::uint32_t>(points.size() - 1) * n;
  for (const bool end : {false, true}) {
    const std::uint32_t ring = end ? last : 0;
    std::vector<Eigen::Vector3d> cap(mesh.vertices.begin() + ring,
                                     mesh.vertices.begin() + ring + n);
    if (!end)
      std::reverse(cap.begin(), cap.end());
    const std::uint32_t first = mesh.addFlat(cap);
    for (std::uint32_t k = 1; k + 1 < n; ++k)
      add(first, first + k, first + k + 1);
  }
  return mesh;
}

Mesh
ellipsoidMesh(const Eigen::Vector3d& half, int segments, int material)
{
  std::vector<Ring> rings;
  const int rows = std::max(4, segments / 2);
  for (int i = 0; i <= rows; ++i) {
    const double turn = 0.5 * i / rows - 0.25;
    const double r = i == 0 || i == rows ? 0.0 : cosineOfTurns(turn);
    Ring ring;
    ring.z = half.z() * sineOfTurns(turn);
    ring.half_x = half.x() * r;
    ring.half_y = half.y() * r;
    ring.material = material;
    rings.push_back(ring);
  }
  return loftMesh(rings, segments);
}

Mesh
fanMesh(const std::vector<Eigen::Vector3d>& corners, int material)
{
  Mesh mesh;
  if (corners.size() < 3)
    return mesh;
  mesh.addFlat(corners);
  for (std::uint32_t k = 1; k + 1 < corners.size(); ++k)
    mesh.triangles.push_back(
        {{{0, k, k + 1}}, static_cast<std::uint16_t>(material), Mesh::no_face});
  return mesh;
}

} // namespace simulation
} // namespace hoist
