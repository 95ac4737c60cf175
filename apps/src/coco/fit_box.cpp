#include "coco/fit_box.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace hoist {
namespace {

constexpr double jump = 0.03; // of the depth: more between neighbours is a step
constexpr std::size_t least_points = 20;
constexpr std::size_t most_points = 2000; // that the angle is taken from

// A number below which one in a hundred lies, and one above which one does.
std::pair<double, double>
innerRange(std::vector<double> numbers)
{
  const std::size_t cut = numbers.size() / 100;
  const auto low = numbers.begin() + static_cast<std::ptrdiff_t>(cut);
  std::nth_element(numbers.begin(), low, numbers.end());
  const double from = *low;
  const auto high = numbers.end() - 1 - static_cast<std::ptrdiff_t>(cut);
  std::nth_element(numbers.begin(), high, numbers.end());
  return {from, *high};
}

bool
besideStep(const cv::Mat1b& mask, const cv::Mat1f& depth, int v, int u)
{
  const float z = depth(v, u);
  for (int dv = -1; dv <= 1; ++dv)
    for (int du = -1; du <= 1; ++du) {
      const int y = v + dv, x = u + du;
      if (y < 0 || x < 0 || y >= depth.rows || x >= depth.cols || mask(y, x) == 0)
        continue;
      if (std::isfinite(depth(y, x)) && std::abs(depth(y, x) - z) > jump * z)
        return true;
    }
  return false;
}

// Mean distance of points to the nearest side of the rectangle at this angle around
// them. The smallest area tells nothing of two walls that meet: all of the points lie
// in a right triangle, and a rectangle along its third side is as small as one along
// the walls.
double
meanDistance(const std::vector<Eigen::Vector2d>& points, double angle)
{
  const Eigen::Vector2d axis(std::cos(angle), std::sin(angle));
  std::vector<double> x, y;
  x.reserve(points.size());
  y.reserve(points.size());
  for (const Eigen::Vector2d& p : points) {
    x.push_back(axis.dot(p));
    y.push_back(axis.x() * p.y() - axis.y() * p.x());
  }
  const auto [left, right] = innerRange(x);
  const auto [low, high] = innerRange(y);
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    sum += std::min({std::abs(x[i] - left),
                     std::abs(x[i] - right),
                     std::abs(y[i] - low),
                     std::abs(y[i] - high)});
  return sum / static_cast<double>(x.size());
}

// In [0, 90) degrees, to a tenth.
double
bestAngle(const std::vector<Eigen::Vector2d>& points)
{
  constexpr double degree = CV_PI / 180;
  double best = 0, least = std::numeric_limits<double>::infinity();
  const auto search = [&](double from, double step, int n) {
    for (int i = 0; i < n; ++i) {
      const double angle = from + i * step;
      const double mean = meanDistance(points, angle);
      if (mean < least) {
        least = mean;
        best = angle;
      }
    }
  };
  search(0, degree, 90);
  search(best - degree, 0.1 * degree, 21);
  return best;
}

} // namespace

std::vector<Eigen::Vector3d>
pointsOf(const cv::Mat1b& mask, const cv::Mat1f& depth, const Intrinsics& camera)
{
  std::vector<Eigen::Vector3d> points;
  std::vector<double> depths;
  for (int v = 0; v < mask.rows; ++v)
    for (int u = 0; u < mask.cols; ++u)
      if (mask(v, u) != 0 && std::isfinite(depth(v, u)) &&
          !besideStep(mask, depth, v, u)) {
        const double z = depth(v, u);
        points.emplace_back(z * camera.ray(u, v));
        depths.push_back(z);
      }
  if (points.size() < least_points)
    return points;
  // an outline that is drawn too wide shows some of what is behind: it lies far from
  // the middle half
  std::sort(depths.begin(), depths.end());
  const double quarter = depths[depths.size() / 4];
  const double three = depths[3 * depths.size() / 4];
  const double reach = 3 * (three - quarter) + jump * three;
  points.erase(std::remove_if(points.begin(),
                              points.end(),
                              [&](const Eigen::Vector3d& p) {
                                return p.z() < quarter - reach || p.z() > three + reach;
                              }),
               points.end());
  return points;
}

std::optional<OrientedBox>
uprightBox(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& up)
{
  if (points.size() < least_points)
    return std::nullopt;
  Eigen::Matrix3d axes;
  axes.col(2) = up.normalized();
  axes.col(0) = axes.col(2).unitOrthogonal();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  std::vector<Eigen::Vector2d> seen_from_above;
  const std::size_t step = points.size() / most_points + 1;
  for (std::size_t i = 0; i < points.size(); i += step)
    seen_from_above.emplace_back(axes.leftCols<2>().transpose() * points[i]);
  const double angle = bestAngle(seen_from_above);
  axes = axes * Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();

  Eigen::Vector3d low, high;
  for (int i = 0; i < 3; ++i) {
    std::vector<double> along;
    along.reserve(points.size());
    for (const Eigen::Vector3d& p : points)
      along.push_back(axes.col(i).dot(p));
    std::tie(low[i], high[i]) = innerRange(std::move(along));
  }
  const Eigen::Vector3d size = high - low;
  if (size.minCoeff() <= 1e-6)
    return std::nullopt;
  return OrientedBox(axes * (low + high) / 2, size, axes);
}

} // namespace hoist
