#include <hoist/data/estimate_intrinsics.h>

#include <algorithm>
#include <cmath>

namespace hoist {
namespace {

// One coordinate: pixel = f * ray + c.
struct Axis {
  double f = 0;
  double c = 0;
};

// Weighted line fit; false when the rays do not span a range.
bool
fitAxis(const Eigen::Ref<const Eigen::VectorXd>& ray,
        const Eigen::Ref<const Eigen::VectorXd>& pixel,
        const Eigen::VectorXd& weight,
        Axis& axis)
{
  const double w = weight.sum();
  if (w <= 0)
    return false;
  const double ray_mean = weight.dot(ray) / w;
  const double pixel_mean = weight.dot(pixel) / w;
  const Eigen::VectorXd r = ray.array() - ray_mean;
  const double spread = (weight.array() * r.array().square()).sum();
  if (spread <= 1e-12 * w)
    return false;
  axis.f = (weight.array() * r.array() * (pixel.array() - pixel_mean)).sum() / spread;
  axis.c = pixel_mean - axis.f * ray_mean;
  return true;
}

double
median(Eigen::VectorXd values)
{
  const auto middle = values.data() + values.size() / 2;
  std::nth_element(values.data(), middle, values.data() + values.size());
  return *middle;
}

} // namespace

Intrinsics
estimateIntrinsics(const Eigen::Ref<const Eigen::MatrixX2d>& rays,
                   const Eigen::Ref<const Eigen::MatrixX2d>& pixels)
{
  constexpr int min_records = 8;
  constexpr int iterations = 20;
  constexpr double scale_floor = 1e-3; // [px]; exact data must not divide by zero
  constexpr double tukey = 4.685;      // 95 % efficiency under normal noise

  Intrinsics camera;
  camera.records = static_cast<std::size_t>(rays.rows());
  if (rays.rows() < min_records || rays.rows() != pixels.rows())
    return camera;

  Axis u, v;
  Eigen::VectorXd weight = Eigen::VectorXd::Ones(rays.rows());
  Eigen::VectorXd residual;
  for (int i = 0; i < iterations; ++i) {
    if (!fitAxis(rays.col(0), pixels.col(0), weight, u) ||
        !fitAxis(rays.col(1), pixels.col(1), weight, v))
      return camera;
    residual = ((u.f * rays.col(0).array() + u.c - pixels.col(0).array()).square() +
                (v.f * rays.col(1).array() + v.c - pixels.col(1).array()).square())
                   .sqrt();
    const double scale = std::max(scale_floor, 1.4826 * median(residual)) * tukey;
    weight = (residual.array() < scale)
                 .select((1 - (residual.array() / scale).square()).square(), 0.0);
  }
  if (u.f <= 0 || v.f <= 0 || !std::isfinite(u.f) || !std::isfinite(v.f))
    return camera;

  double sum = 0;
  for (Eigen::Index i = 0; i < residual.size(); ++i)
    if (weight[i] > 0) {
      sum += residual[i] * residual[i];
      ++camera.inliers;
    }
  if (camera.inliers < min_records)
    return camera;
  camera.fx = u.f;
  camera.cx = u.c;
  camera.fy = v.f;
  camera.cy = v.c;
  camera.rms = std::sqrt(sum / static_cast<double>(camera.inliers));
  return camera;
}

Intrinsics
estimateIntrinsics(const cv::Mat3f& points, int max_records)
{
  const int step = std::max(
      1,
      static_cast<int>(std::sqrt(static_cast<double>(points.total()) / max_records)));
  Eigen::MatrixX2d rays(max_records * 4, 2), pixels(max_records * 4, 2);
  Eigen::Index n = 0;
  for (int v = step / 2; v < points.rows; v += step)
    for (int u = step / 2; u < points.cols && n < rays.rows(); u += step) {
      const cv::Vec3f& p = points(v, u);
      if (!(p[2] > 0) || !std::isfinite(p[0]) || !std::isfinite(p[1]))
        continue;
      rays.row(n) << p[0] / p[2], p[1] / p[2];
      pixels.row(n) << u, v;
      ++n;
    }
  return estimateIntrinsics(rays.topRows(n), pixels.topRows(n));
}

} // namespace hoist
