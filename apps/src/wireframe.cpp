#include "wireframe.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hoist {
namespace {

constexpr double near_plane = 0.05; // [m]

// Where a ray from the origin enters a cuboid, in lengths of the ray; infinity if it
// does not.
double
entry(const Cuboid& cuboid, const Eigen::Vector3d& ray)
{
  const Eigen::Vector3d origin = -(cuboid.axes.transpose() * cuboid.center);
  const Eigen::Vector3d way = cuboid.axes.transpose() * ray;
  double in = 0, out = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const double half = 0.5 * cuboid.size[i];
    if (way[i] == 0) {
      if (std::abs(origin[i]) > half)
        return std::numeric_limits<double>::infinity();
      continue;
    }
    const double a = (-half - origin[i]) / way[i], b = (half - origin[i]) / way[i];
    in = std::max(in, std::min(a, b));
    out = std::min(out, std::max(a, b));
  }
  return in < out ? in : std::numeric_limits<double>::infinity();
}

// Cuts what lies behind the camera off a line; false if all does.
bool
clip(Eigen::Vector3d& p, Eigen::Vector3d& q)
{
  if (p.z() < near_plane && q.z() < near_plane)
    return false;
  Eigen::Vector3d& behind = p.z() < q.z() ? p : q;
  const Eigen::Vector3d& front = p.z() < q.z() ? q : p;
  if (behind.z() < near_plane)
    behind += (front - behind) * ((near_plane - behind.z()) / (front.z() - behind.z()));
  return true;
}

} // namespace

Wireframes::Wireframes(std::vector<Cuboid> cuboids,
                       const FrameImages& images,
                       int scale)
: cuboids_(std::move(cuboids))
, camera_(images.intrinsics)
, inverse_depth_(images.inverse_depth)
, scale_(scale)
{
}

cv::Point2f
Wireframes::pixel(const Eigen::Vector3d& p) const
{
  // far outside the picture is as good as anywhere outside, and fits an int
  constexpr double limit = 30000;
  const Eigen::Vector2d uv = (scale_ * (camera_.project(p) + Eigen::Vector2d(0.5, 0.5)))
                                 .cwiseMax(-limit)
                                 .cwiseMin(limit);
  return {static_cast<float>(uv.x()), static_cast<float>(uv.y())};
}

bool
Wireframes::behindMeasured(const Eigen::Vector3d& p) const
{
  const cv::Point2f at = pixel(p) / scale_;
  const int u = cvFloor(at.x), v = cvFloor(at.y);
  if (u < 0 || v < 0 || u >= inverse_depth_.cols || v >= inverse_depth_.rows)
    return false;
  // an edge's own points are noisy and a pixel or two off; things are further apart
  const double slack = 0.02 + 0.01 * p.z(); // [m]
  return inverse_depth_(v, u) * (p.z() - slack) > 1.0;
}

bool
Wireframes::covered(const Eigen::Vector3d& p) const
{
  // boxes touch and are a few mm off: what lies this little behind a face is on it
  const double slack = 0.006 + 0.002 * p.norm(); // [m]
  const double before = 1.0 - slack / p.norm();
  const auto covers = [&](const Cuboid& cuboid) { return entry(cuboid, p) < before; };
  return std::any_of(cuboids_.begin(), cuboids_.end(), covers) || behindMeasured(p);
}

std::vector<EdgePiece>
Wireframes::edges(std::size_t cuboid) const
{
  const Eigen::Matrix<double, 3, 8> corners = cuboids_[cuboid].corners();
  std::vector<EdgePiece> pieces;
  for (const auto& edge : Cuboid::edges()) {
    Eigen::Vector3d p = corners.col(edge[0]), q = corners.col(edge[1]);
    if (!clip(p, q))
      continue;
    const double length = cv::norm(pixel(q) - pixel(p));
    const int steps = std::clamp(static_cast<int>(length / 3.0), 1, 400);
    const auto at = [&](double step) -> Eigen::Vector3d {
      return p + (q - p) * (step / steps);
    };
    int begin = 0;
    bool hidden = covered(at(0.5));
    for (int i = 1; i <= steps; ++i) {
      const bool next = i < steps ? covered(at(i + 0.5)) : !hidden;
      if (next == hidden)
        continue;
      pieces.push_back({pixel(at(begin)), pixel(at(i)), hidden});
      begin = i;
      hidden = next;
    }
  }
  return pieces;
}

cv::Mat1i
Wireframes::owners(cv::Size picture) const
{
  const cv::Size frame(picture.width / scale_, picture.height / scale_);
  cv::Mat1i owner(frame, -1);
  cv::Mat1d depth(frame, std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < cuboids_.size(); ++i) {
    std::vector<cv::Point2f> points;
    for (const EdgePiece& piece : edges(i)) {
      points.push_back(piece.from / scale_);
      points.push_back(piece.to / scale_);
    }
    if (points.empty())
      continue;
    const cv::Rect bounds = cv::boundingRect(points) & cv::Rect({}, frame);
    for (int v = bounds.y; v < bounds.br().y; ++v)
      for (int u = bounds.x; u < bounds.br().x; ++u) {
        const double z = entry(cuboids_[i], camera_.ray(u, v));
        if (z < depth(v, u)) {
          depth(v, u) = z;
          owner(v, u) = static_cast<int>(i);
        }
      }
  }
  cv::Mat1i large;
  cv::resize(owner, large, picture, 0, 0, cv::INTER_NEAREST);
  return large;
}

} // namespace hoist
