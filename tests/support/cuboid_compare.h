#pragma once

// How far two cuboids are apart, for tests: errors modulo the 24 ways to name the axes
// of a box, and the exact 3D IoU. The rules are those of the mOSD evaluation: the
// naming with the smallest rotation counts, sizes are compared under that naming.

#include <hoist/data/cuboid.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace hoist {
namespace test {

/** \brief The 24 rotations of a cube: signed permutation matrices, determinant +1. */
inline const std::vector<Eigen::Matrix3d>&
cubeRotations()
{
  static const std::vector<Eigen::Matrix3d> all = [] {
    std::vector<Eigen::Matrix3d> list;
    std::array<int, 3> p = {0, 1, 2};
    do {
      for (int signs = 0; signs < 8; ++signs) {
        Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
        for (int i = 0; i < 3; ++i)
          m(p[i], i) = (signs >> i & 1) != 0 ? -1 : 1;
        if (m.determinant() > 0)
          list.push_back(m);
      }
    } while (std::next_permutation(p.begin(), p.end()));
    return list;
  }();
  return all;
}

/** \brief The same box with axes * m as its axes; \a m from cubeRotations(). Sigmas,
 *  faces and sources are carried along. */
inline Cuboid
renamed(const Cuboid& cuboid, const Eigen::Matrix3d& m)
{
  Cuboid out = cuboid;
  out.axes = cuboid.axes * m;
  for (int i = 0; i < 3; ++i) {
    int from = 0;
    m.col(i).cwiseAbs().maxCoeff(&from);
    const bool flip = m(from, i) < 0;
    out.size[i] = cuboid.size[from];
    out.size_sigma[i] = cuboid.size_sigma[from];
    out.dimension_source[i] = cuboid.dimension_source[from];
    out.observed_faces[2 * i] = cuboid.observed_faces[2 * from + (flip ? 1 : 0)];
    out.observed_faces[2 * i + 1] = cuboid.observed_faces[2 * from + (flip ? 0 : 1)];
  }
  return out;
}

struct CuboidErrors {
  double center = 0;                              ///< distance of the centres [m]
  double rotation = 0;                            ///< angle between the axes [rad]
  Eigen::Vector3d size = Eigen::Vector3d::Zero(); ///< found minus true [m], in the
                                                  ///< order of the truth's axes
  double
  maxSize() const
  {
    return size.cwiseAbs().maxCoeff();
  }
};

/** \brief Errors of \a found against \a truth under the best naming of its axes.
 *
 * Among namings of nearly the same rotation (within 1 degree: boxes turned by 45
 * degrees and noise) the one with the smaller size error is taken.
 */
inline CuboidErrors
compare(const Cuboid& found, const Cuboid& truth)
{
  CuboidErrors best;
  double best_cost = std::numeric_limits<double>::infinity();
  for (const Eigen::Matrix3d& m : cubeRotations()) {
    const Cuboid named = renamed(found, m);
    const Eigen::Matrix3d turn = truth.axes.transpose() * named.axes;
    // exact for small angles too, where the arc cosine of the trace is not
    const double sine = 0.5 * Eigen::Vector3d(turn(2, 1) - turn(1, 2),
                                              turn(0, 2) - turn(2, 0),
                                              turn(1, 0) - turn(0, 1))
                                  .norm();
    const double angle = std::atan2(sine, 0.5 * (turn.trace() - 1));
    const Eigen::Vector3d size = named.size - truth.size;
    const double cost = angle + size.norm() / truth.size.norm() * 0.0175;
    if (cost < best_cost) {
      best_cost = cost;
      best.rotation = angle;
      best.size = size;
    }
  }
  best.center = (found.center - truth.center).norm();
  return best;
}

namespace detail {

using Polygon = std::vector<Eigen::Vector3d>;

struct Face {
  Eigen::Vector3d normal;
  double offset; // inside: normal . p <= offset
  Polygon polygon;
};

inline std::vector<Face>
facesOf(const Cuboid& c, const Eigen::Vector3d& origin)
{
  std::vector<Face> faces;
  for (int a = 0; a < 3; ++a)
    for (const double side : {1.0, -1.0}) {
      const Eigen::Vector3d n = side * c.axes.col(a);
      const Eigen::Vector3d m = c.center - origin + n * c.size[a] / 2;
      const Eigen::Vector3d u = c.axes.col((a + 1) % 3) * c.size[(a + 1) % 3] / 2;
      const Eigen::Vector3d v = c.axes.col((a + 2) % 3) * c.size[(a + 2) % 3] / 2;
      faces.push_back({n, n.dot(m), {m + u + v, m - u + v, m - u - v, m + u - v}});
    }
  return faces;
}

inline Polygon
clip(const Polygon& polygon, const Face& plane)
{
  Polygon out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d& a = polygon[i];
    const Eigen::Vector3d& b = polygon[(i + 1) % polygon.size()];
    const double ha = plane.normal.dot(a) - plane.offset;
    const double hb = plane.normal.dot(b) - plane.offset;
    if (ha <= 0)
      out.push_back(a);
    if ((ha < 0 && hb > 0) || (ha > 0 && hb < 0))
      out.push_back(a + (b - a) * (ha / (ha - hb)));
  }
  return out;
}

inline double
area(const Polygon& polygon)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i)
    sum += (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]);
  return sum.norm() / 2;
}

} // namespace detail

/** \brief Volume that two cuboids share [m^3], exact. */
inline double
intersectionVolume(const Cuboid& a, const Cuboid& b)
{
  // Divergence theorem: the shared body's faces are faces of one clipped by the other.
  const Eigen::Vector3d origin = (a.center + b.center) / 2;
  const auto faces_a = detail::facesOf(a, origin), faces_b = detail::facesOf(b, origin);
  const double eps = 1e-12 * (a.size.norm() + b.size.norm());
  double volume = 0;
  const auto add = [&](const std::vector<detail::Face>& faces,
                       const std::vector<detail::Face>& planes,
                       bool keep_coplanar) {
    for (const auto& face : faces) {
      detail::Polygon polygon = face.polygon;
      for (const auto& plane : planes) {
        // a face that both have in common counts once, wherever rounding puts it
        const bool common = face.normal.dot(plane.normal) > 1 - 1e-12 &&
                            std::abs(face.offset - plane.offset) < eps;
        if (!common)
          polygon = detail::clip(polygon, plane);
        else if (!keep_coplanar)
          polygon.clear();
      }
      volume += face.offset * detail::area(polygon) / 3;
    }
  };
  add(faces_a, faces_b, true);
  add(faces_b, faces_a, false);
  return std::max(0.0, volume);
}

/** \brief Intersection over union, in [0, 1]. */
inline double
iou(const Cuboid& a, const Cuboid& b)
{
  const double shared = intersectionVolume(a, b);
  return shared / (a.volume() + b.volume() - shared);
}

} // namespace test
} // namespace hoist
