#include "refinement_outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hoist {
namespace detail {
namespace {

// From the pixel on the face to the middle of its side.
Eigen::Vector2d
halfStep(const BorderElement& e, const Intrinsics& camera)
{
  const Eigen::Vector2d pixel = e.pixel.cast<double>();
  const Eigen::Vector3d point = e.point.cast<double>();
  const Eigen::Vector3d beyond = point + 1e-3 * point.z() * e.outward.cast<double>();
  const Eigen::Vector2d ahead = camera.project(beyond) - pixel;
  if (pixel.x() != std::floor(pixel.x())) // the side is upright
    return {ahead.x() > 0 ? 0.5 : -0.5, 0};
  return {0, ahead.y() > 0 ? 0.5 : -0.5};
}

} // namespace

void
addOutline(const CuboidHypothesis& h,
           const CuboidEvidence& evidence,
           int label,
           int f,
           const std::vector<PlanarFace>& faces,
           const FaceBorders& borders,
           const Intrinsics& camera,
           double noise,
           std::vector<OutlinePoint>& outline)
{
  constexpr double lateral_noise = 0.8; // of an outline element [px]
  std::array<double, 3> step{};         // what a pixel is worth along each axis [m]
  for (int i = 0; i < 3; ++i)
    step[i] = footprint(faces[label], h.axes.col(i), camera);
  for (int i = borders.first[label]; i < borders.first[label + 1]; ++i) {
    const BorderElement& e = borders.elements[i];
    if (e.kind == BorderKind::occluded || e.kind == BorderKind::cut)
      continue;
    const Eigen::Vector3d local = h.axes.transpose() * e.point.cast<double>();
    const Eigen::Vector3d outward = e.outward.cast<double>();
    int end = -1;
    double nearest = 1; // in units of the reach
    for (int g = 0; g < 6; ++g) {
      // ends at visible faces are where two planes meet: the pixels know them better
      if (g / 2 == f / 2 || evidence.visible[g])
        continue;
      const double reach = 1.5 * step[g / 2] + 0.5 * noise;
      const double d = std::abs(local[g / 2] - h.end(g)) / reach;
      if (d < nearest && h.outward(g).dot(outward) >= 0.3) {
        nearest = d;
        end = g;
      }
    }
    if (end < 0)
      continue;
    const double lateral = lateral_noise * step[end / 2];
    OutlinePoint point{&e, e.point.cast<double>(), f, end, lateral, lateral, false};
    // Where the box stands on something, the two planes say better than the pixels
    // where the face ends.
    const Eigen::Vector3d axis = h.outward(end);
    if (e.kind == BorderKind::crease && e.neighbour >= 0 &&
        faces[e.neighbour].normal.dot(axis) < -0.96) {
      const PlanarFace& support = faces[e.neighbour];
      const double t = -(support.normal.dot(point.point) + support.offset) /
                       support.normal.dot(axis);
      if (std::abs(t) < 2 * step[end / 2] + noise) {
        point.point += t * axis;
        point.sigma = 0.5 * noise;
        point.on_plane = true;
      }
    }
    outline.push_back(point);
  }
}

void
settleBetweenPixels(const std::vector<OutlinePoint>& outline,
                    const Intrinsics& camera,
                    double pixel,
                    CuboidHypothesis& h)
{
  struct Interval {
    double last = -std::numeric_limits<double>::infinity();
    double first = std::numeric_limits<double>::infinity();
    int points = 0;
    bool planes = false; // better known than by pixels
  };
  std::array<Interval, 6> intervals;
  for (const OutlinePoint& p : outline) {
    Interval& in = intervals[p.end];
    in.planes |= p.on_plane;
    const int axis = p.end / 2, across = 3 - p.face / 2 - axis;
    const auto lift = [&](const Eigen::Vector2d& q) -> Eigen::Vector3d {
      const Eigen::Vector3d ray = h.axes.transpose() * camera.ray(q.x(), q.y());
      return ray * (h.end(p.face) / ray[p.face / 2]);
    };
    const double side = CuboidHypothesis::side(p.end);
    const Eigen::Vector2d middle = p.element->pixel.cast<double>();
    const Eigen::Vector2d half = halfStep(*p.element, camera);
    in.last = std::max(in.last, side * lift(middle - half)[axis]);
    const Eigen::Vector3d beyond = lift(middle + half);
    // near the corner it may lie beyond another end as well, and says nothing then
    const double margin = 1.5 * pixel;
    if (beyond[across] < h.lower[across] + margin ||
        beyond[across] > h.upper[across] - margin)
      continue;
    in.first = std::min(in.first, side * beyond[axis]);
    ++in.points;
  }
  for (int g = 0; g < 6; ++g) {
    const Interval& in = intervals[g];
    constexpr int min_points = 6;
    const double side = CuboidHypothesis::side(g);
    if (!in.planes && in.points >= min_points && in.last < in.first)
      h.end(g) = side * (in.last + in.first) / 2;
  }
}

} // namespace detail
} // namespace hoist
