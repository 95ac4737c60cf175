#include "raycast.h"

#include <cmath>
#include <utility>

namespace hoist {
namespace samples {
namespace {

constexpr double skin = 1e-7; // a ray that starts on a surface must not meet it again

bool
castCylinder(const Cylinder& c,
             const Eigen::Vector3d& origin,
             const Eigen::Vector3d& direction,
             Hit& hit)
{
  const Eigen::Vector3d o = origin - c.center;
  const double oa = o.dot(c.axis), da = direction.dot(c.axis);
  const Eigen::Vector3d op = o - oa * c.axis, dp = direction - da * c.axis;
  bool found = false;
  const auto take = [&](double d, int face, const Eigen::Vector3d& normal) {
    if (d <= skin || d >= hit.distance)
      return;
    hit.distance = d;
    hit.face = face;
    hit.normal = normal;
    // position along the axis and across; ends and side share it, a can has no seam
    const Eigen::Vector3d p = o + d * direction;
    hit.s = p.dot(c.axis.unitOrthogonal());
    hit.t = face == 0 ? p.dot(c.axis) : p.dot(c.axis.cross(c.axis.unitOrthogonal()));
    hit.half = {c.radius, face == 0 ? c.height / 2 : c.radius};
    found = true;
  };
  const double a = dp.squaredNorm(), b = op.dot(dp);
  const double disc = b * b - a * (op.squaredNorm() - c.radius * c.radius);
  if (a > 0 && disc > 0) {
    const double d = (-b - std::sqrt(disc)) / a;
    if (std::abs(oa + d * da) <= c.height / 2)
      take(d, 0, (op + d * dp) / c.radius);
  }
  for (const int end : {1, -1}) {
    if (da == 0)
      continue;
    const double d = (end * c.height / 2 - oa) / da;
    if ((op + d * dp).squaredNorm() <= c.radius * c.radius)
      take(d, end > 0 ? 1 : 2, end * c.axis);
  }
  return found;
}

bool
castPatch(const Patch& patch,
          const Eigen::Vector3d& origin,
          const Eigen::Vector3d& direction,
          Hit& hit)
{
  const Eigen::Vector3d normal = patch.axes.col(2);
  const double slope = direction.dot(normal);
  if (slope == 0)
    return false;
  const double d = (patch.center - origin).dot(normal) / slope;
  if (d <= skin || d >= hit.distance)
    return false;
  const Eigen::Vector3d p = origin + d * direction - patch.center;
  const double s = p.dot(patch.axes.col(0)), t = p.dot(patch.axes.col(1));
  if (std::abs(s) > patch.half_size.x() || std::abs(t) > patch.half_size.y())
    return false;
  hit.distance = d;
  hit.face = 0;
  hit.normal = slope < 0 ? normal : Eigen::Vector3d(-normal);
  hit.s = s;
  hit.t = t;
  hit.half = patch.half_size;
  return true;
}

} // namespace

bool
cast(const Box& box,
     const Eigen::Vector3d& origin,
     const Eigen::Vector3d& direction,
     Hit& hit)
{
  const Eigen::Vector3d o = box.axes.transpose() * (origin - box.center);
  const Eigen::Vector3d d = box.axes.transpose() * direction;
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();
  int axis = -1;
  for (int i = 0; i < 3; ++i) {
    const double half = box.size[i] / 2;
    if (d[i] == 0) {
      if (std::abs(o[i]) > half)
        return false;
      continue;
    }
    double a = (-half - o[i]) / d[i], b = (half - o[i]) / d[i];
    if (a > b)
      std::swap(a, b);
    if (a > enter) {
      enter = a;
      axis = i;
    }
    leave = std::min(leave, b);
  }
  // seen from outside only: a camera inside a box sees nothing of it
  if (axis < 0 || enter > leave || enter <= skin || enter >= hit.distance)
    return false;
  const bool positive = d[axis] < 0;
  const int first = (axis + 1) % 3, second = (axis + 2) % 3;
  const Eigen::Vector3d p = o + enter * d;
  hit.distance = enter;
  hit.face = 2 * axis + (positive ? 0 : 1);
  hit.normal = (positive ? 1.0 : -1.0) * box.axes.col(axis);
  hit.s = p[first];
  hit.t = p[second];
  hit.half = {box.size[first] / 2, box.size[second] / 2};
  return true;
}

Hit
cast(const Scene& scene,
     const Eigen::Vector3d& origin,
     const Eigen::Vector3d& direction)
{
  Hit hit;
  int object = 0;
  for (const Box& box : scene.boxes) {
    if (cast(box, origin, direction, hit))
      hit.object = object;
    ++object;
  }
  for (const Cylinder& cylinder : scene.cylinders) {
    if (castCylinder(cylinder, origin, direction, hit))
      hit.object = object;
    ++object;
  }
  for (const Patch& patch : scene.patches) {
    if (castPatch(patch, origin, direction, hit))
      hit.object = object;
    ++object;
  }
  return hit;
}

bool
blocked(const Scene& scene, const Eigen::Vector3d& from, const Eigen::Vector3d& to)
{
  return cast(scene, from, to - from).distance < 1.0 - skin;
}

} // namespace samples
} // namespace hoist
