#include <hoist/data/oriented_box.h>

#include <Eigen/SVD>

#include <algorithm>
#include <cmath>

namespace hoist {
namespace {

// A convex polygon in a plane. Cut by six planes a rectangle gets ten corners at most.
struct Polygon {
  std::array<Eigen::Vector3d, 16> corners;
  int n = 0;

  void
  add(const Eigen::Vector3d& p)
  {
    if (n < static_cast<int>(corners.size()))
      corners[static_cast<std::size_t>(n++)] = p;
  }
};

struct Face {
  Eigen::Vector3d normal; // outward
  double offset;          // inside: normal . p <= offset
  Polygon polygon;
};

using Faces = std::array<Face, 6>;

Faces
facesOf(const OrientedBox& box, const Eigen::Vector3d& origin)
{
  Faces faces;
  for (int a = 0; a < 3; ++a)
    for (int side = 0; side < 2; ++side) {
      Face& face = faces[2 * a + side];
      face.normal = (side == 0 ? 1.0 : -1.0) * box.axes.col(a);
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      const Eigen::Vector3d middle =
          box.center - origin + face.normal * box.size[a] / 2;
      const Eigen::Vector3d u = box.axes.col(b) * box.size[b] / 2;
      const Eigen::Vector3d v = box.axes.col(c) * box.size[c] / 2;
      face.offset = face.normal.dot(middle);
      face.polygon.add(middle + u + v);
      face.polygon.add(middle - u + v);
      face.polygon.add(middle - u - v);
      face.polygon.add(middle + u - v);
    }
  return faces;
}

// Sutherland and Hodgman's step: what of the polygon is inside of the plane.
Polygon
clipped(const Polygon& polygon, const Face& plane)
{
  std::array<double, 16> height{};
  for (int i = 0; i < polygon.n; ++i)
    height[i] = plane.normal.dot(polygon.corners[i]) - plane.offset;
  Polygon out;
  for (int i = 0; i < polygon.n; ++i) {
    const int j = (i + 1) % polygon.n;
    const double hi = height[i], hj = height[j];
    if (hi <= 0)
      out.add(polygon.corners[i]);
    if ((hi < 0 && hj > 0) || (hi > 0 && hj < 0))
      out.add(polygon.corners[i] +
              (polygon.corners[j] - polygon.corners[i]) * (hi / (hi - hj)));
  }
  return out;
}

bool
liesIn(const Polygon& polygon, const Face& plane, double tolerance)
{
  for (int i = 0; i < polygon.n; ++i)
    if (std::abs(plane.normal.dot(polygon.corners[i]) - plane.offset) >= tolerance)
      return false;
  return true;
}

double
areaAlong(const Polygon& polygon, const Eigen::Vector3d& normal)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 2; i < polygon.n; ++i)
    sum += (polygon.corners[i - 1] - polygon.corners[0])
               .cross(polygon.corners[i] - polygon.corners[0]);
  return std::abs(sum.dot(normal)) / 2;
}

// What the faces of one box that are inside of the other add to the shared volume. A
// face that both have in common counts for one of them only.
double
shareOf(const Faces& faces, const Faces& other, bool keep_common, double tolerance)
{
  double volume = 0;
  for (const Face& face : faces) {
    Polygon polygon = face.polygon;
    for (const Face& plane : other) {
      if (!liesIn(polygon, plane, tolerance))
        polygon = clipped(polygon, plane);
      else if (face.normal.dot(plane.normal) < 0 || !keep_common)
        polygon.n = 0; // the boxes only touch there, or the other's face counts
      if (polygon.n < 3)
        break;
    }
    if (polygon.n >= 3)
      volume += face.offset * areaAlong(polygon, face.normal) / 3;
  }
  return volume;
}

} // namespace

OrientedBox::OrientedBox(const Eigen::Vector3d& center_,
                         const Eigen::Vector3d& size_,
                         const Eigen::Matrix3d& rotation_)
: center(center_), size(size_)
{
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(
      rotation_, Eigen::ComputeFullU | Eigen::ComputeFullV);
  axes = svd.matrixU() * svd.matrixV().transpose();
  if (axes.determinant() < 0)
    axes.col(2) *= -1;
}

double
intersectionVolume(const OrientedBox& a, const OrientedBox& b)
{
  const double reach = (a.size.norm() + b.size.norm()) / 2;
  if ((a.center - b.center).norm() >= reach)
    return 0;
  // an origin near the boxes keeps the sum of large terms from losing digits
  const Eigen::Vector3d origin = a.center;
  const Faces faces_a = facesOf(a, origin), faces_b = facesOf(b, origin);
  const double tolerance = 1e-9 * reach;
  const double volume = shareOf(faces_a, faces_b, true, tolerance) +
                        shareOf(faces_b, faces_a, false, tolerance);
  return std::clamp(volume, 0.0, std::min(a.volume(), b.volume()));
}

double
intersectionOverUnion(const OrientedBox& a, const OrientedBox& b)
{
  const double shared = intersectionVolume(a, b);
  return shared / (a.volume() + b.volume() - shared);
}

} // namespace hoist
