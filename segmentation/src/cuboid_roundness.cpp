#include <hoist/segmentation/cuboid_roundness.h>

#include "cuboid_view.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace hoist {
namespace {

// Squared distance to the profile of two faces that meet in a corner at the origin and
// lie where x or y is zero and the other negative.
double
cornerDistance(const Eigen::Vector2d& p)
{
  if (p.x() > 0 && p.y() > 0)
    return p.squaredNorm();
  const double d = std::min(std::abs(p.x()), std::abs(p.y()));
  return p.x() > 0 ? p.x() * p.x() : p.y() > 0 ? p.y() * p.y() : d * d;
}

struct Circle {
  Eigen::Vector2d center;
  double radius = 0;
};

// Weighted algebraic least squares: |p|^2 = 2 c.p + (r^2 - |c|^2).
bool
fitCircle(const std::vector<Eigen::Vector2d>& points,
          const std::vector<double>& weights,
          Circle& circle)
{
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d row(points[i].x(), points[i].y(), 1);
    normal += weights[i] * row * row.transpose();
    right += weights[i] * points[i].squaredNorm() * row;
  }
  const Eigen::Vector3d x = normal.ldlt().solve(right);
  circle.center = x.head<2>() / 2;
  const double square = x[2] + circle.center.squaredNorm();
  if (!x.allFinite() || square <= 0)
    return false;
  circle.radius = std::sqrt(square);
  return true;
}

// Sum of the squared distances, each at most the square of the gate.
double
circleCost(const std::vector<Eigen::Vector2d>& points, double gate, double longest)
{
  std::vector<double> weights(points.size(), 1.0);
  Circle circle;
  double best = std::numeric_limits<double>::max();
  constexpr int rounds = 6;
  for (int round = 0; round < rounds; ++round) {
    // a circle that is much larger than the faces is a plane
    if (!fitCircle(points, weights, circle) || circle.radius > 2 * longest)
      break;
    double cost = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double d = (points[i] - circle.center).norm() - circle.radius;
      const double square = d * d / (gate * gate);
      cost += std::min(square, 1.0);
      // the algebraic distance is 2 r d
      weights[i] = 1 / ((1 + square) * (1 + square));
    }
    best = std::min(best, cost);
  }
  return best;
}

} // namespace

double
cuboidRoundness(const CuboidHypothesis& h,
                const cv::Mat1f& inverse_depth,
                const Intrinsics& camera,
                const SensorModel& sensor)
{
  const detail::CuboidView view(h, camera, sensor, inverse_depth.size());
  if (!view.valid())
    return 0;
  const double area = (view.right - view.left + 1.0) * (view.bottom - view.top + 1.0);
  constexpr int max_samples = 1500;
  const int stride =
      std::max(1, static_cast<int>(std::lround(std::sqrt(area / max_samples))));
  const Eigen::Vector3d size = h.size();
  double highest = 0;
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < view.fronts; ++i)
    for (int j = i + 1; j < view.fronts; ++j) {
      const int f = view.front[i], g = view.front[j];
      const int x = f / 2, y = g / 2, z = 3 - x - y;
      const double reach = 0.5 * std::min(size[x], size[y]);
      points.clear();
      for (int v = view.top; v <= view.bottom; v += stride)
        for (int u = view.left; u <= view.right; u += stride) {
          const float w = inverse_depth(v, u);
          if (!(w > 0))
            continue;
          const Eigen::Vector3d p =
              h.axes.transpose() * (view.camera.ray(u, v) / static_cast<double>(w));
          if (p[z] < h.lower[z] || p[z] > h.upper[z])
            continue;
          const Eigen::Vector2d q((p[x] - view.end(f)) * detail::CuboidView::side(f),
                                  (p[y] - view.end(g)) * detail::CuboidView::side(g));
          if (q.x() < -size[x] || q.y() < -size[y] || cornerDistance(q) > reach * reach)
            continue;
          points.push_back(q);
        }
      constexpr std::size_t min_points = 50;
      if (points.size() < min_points)
        continue;
      const double noise = sensor.sigmaZ(h.center().z());
      const double gate = 2.5 * noise + 0.5 * view.pixel;
      double corner = 0;
      for (const Eigen::Vector2d& q : points)
        corner += std::min(cornerDistance(q) / (gate * gate), 1.0);
      const double circle = circleCost(points, gate, std::max(size[x], size[y]));
      highest = std::max(highest, corner / (circle + 1e-9));
    }
  return highest;
}

} // namespace hoist
