#include <hoist/segmentation/cuboid_roundness.h>

#include "cuboid_view.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
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

// What is measured around a box, seen along one of its edges.
class Profile {
public:
  Profile(const detail::CuboidView& view, const cv::Mat1f& inverse_depth)
  : view_(view)
  , size_(view.box.size())
  , noise_(view.sensor.sigmaZ(view.box.center().z()))
  {
    const double area = (view.right - view.left + 1.0) * (view.bottom - view.top + 1.0);
    constexpr int max_samples = 1500;
    const int stride =
        std::max(1, static_cast<int>(std::lround(std::sqrt(area / max_samples))));
    for (int v = view.top; v <= view.bottom; v += stride)
      for (int u = view.left; u <= view.right; u += stride) {
        const float w = inverse_depth(v, u);
        if (w > 0)
          measured_.emplace_back(view.box.axes.transpose() *
                                 (view.camera.ray(u, v) / static_cast<double>(w)));
      }
  }

  // Cost of the corner of faces f and g over the cost of a circle.
  double
  corner(int f, int g)
  {
    const int x = f / 2, y = g / 2;
    collect(f, g);
    return ratio([](const Eigen::Vector2d& q) { return cornerDistance(q); },
                 std::max(size_[x], size_[y]));
  }

  // The same for face f alone, seen along the axis that is neither its own nor y.
  double
  line(int f, int y)
  {
    collect(f, 2 * y + 1);
    return ratio([](const Eigen::Vector2d& q) { return q.x() * q.x(); }, size_[y]);
  }

private:
  // Points near face f, relative to its corner with face g.
  void
  collect(int f, int g)
  {
    const int x = f / 2, y = g / 2, z = 3 - x - y;
    const double reach = 0.5 * std::min(size_[x], size_[y]);
    const bool alone =
        std::find(view_.front.begin(), view_.front.begin() + view_.fronts, g) ==
        view_.front.begin() + view_.fronts;
    points_.clear();
    for (const Eigen::Vector3d& p : measured_) {
      if (p[z] < view_.box.lower[z] || p[z] > view_.box.upper[z])
        continue;
      const Eigen::Vector2d q((p[x] - view_.box.end(f)) * CuboidHypothesis::side(f),
                              (p[y] - view_.box.end(g)) * CuboidHypothesis::side(g));
      if (q.x() < -size_[x] || q.y() < -size_[y])
        continue;
      const double square =
          alone ? (q.y() > 0 ? reach * reach + 1 : q.x() * q.x()) : cornerDistance(q);
      if (square <= reach * reach)
        points_.push_back(q);
    }
  }

  template <typename Distance>
  double
  ratio(const Distance& distance, double longest) const
  {
    constexpr std::size_t min_points = 50;
    if (points_.size() < min_points)
      return 0;
    const double gate = 2.5 * noise_ + 0.5 * view_.pixel;
    double flat = 0;
    for (const Eigen::Vector2d& q : points_)
      flat += std::min(distance(q) / (gate * gate), 1.0);
    return flat / (circleCost(points_, gate, longest) + 1e-9);
  }

  const detail::CuboidView& view_;
  Eigen::Vector3d size_;
  double noise_;                          // [m]
  std::vector<Eigen::Vector3d> measured_; // in the box's axes
  std::vector<Eigen::Vector2d> points_;
};

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
  Profile profile(view, inverse_depth);
  std::array<bool, 3> seen{};
  for (int i = 0; i < view.fronts; ++i)
    seen[view.front[i] / 2] = true;
  double highest = 0;
  for (int i = 0; i < view.fronts; ++i) {
    const int f = view.front[i];
    for (int j = i + 1; j < view.fronts; ++j)
      highest = std::max(highest, profile.corner(f, view.front[j]));
    for (int y = 0; y < 3; ++y)
      if (y != f / 2 && !seen[y])
        highest = std::max(highest, profile.line(f, y));
  }
  return highest;
}

} // namespace hoist
