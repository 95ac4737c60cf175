#include "planar_faces_moments.h"

#include <algorithm>

namespace hoist {
namespace detail {

PlaneMoments&
PlaneMoments::operator+=(const PlaneMoments& o)
{
  n += o.n;
  u += o.u;
  v += o.v;
  uu += o.uu;
  uv += o.uv;
  vv += o.vv;
  w += o.w;
  uw += o.uw;
  vw += o.vw;
  ww += o.ww;
  return *this;
}

void
PlaneMoments::addRun(int first,
                     int row,
                     int count,
                     double sum_w,
                     double sum_kw,
                     double sum_ww)
{
  const double k = count, f = first;
  const double su = k * f + k * (k - 1) / 2;
  n += k;
  u += su;
  v += k * row;
  uu += k * f * f + f * k * (k - 1) + (k - 1) * k * (2 * k - 1) / 6;
  uv += su * row;
  vv += k * row * row;
  w += sum_w;
  uw += sum_kw + f * sum_w;
  vw += sum_w * row;
  ww += sum_ww;
}

bool
PlaneMoments::fit(Eigen::Vector3d& plane) const
{
  if (n < 3)
    return false;
  // centred normal equations: a 2 x 2 system
  const double mu = u / n, mv = v / n, mw = w / n;
  const double cuu = uu - n * mu * mu, cuv = uv - n * mu * mv, cvv = vv - n * mv * mv;
  const double cuw = uw - n * mu * mw, cvw = vw - n * mv * mw;
  const double det = cuu * cvv - cuv * cuv;
  if (det <= 1e-6 * n * n)
    return false;
  plane[0] = (cvv * cuw - cuv * cvw) / det;
  plane[1] = (cuu * cvw - cuv * cuw) / det;
  plane[2] = mw - plane[0] * mu - plane[1] * mv;
  return true;
}

void
PlaneMoments::residual(const Eigen::Vector3d& p,
                       double& mean,
                       double& mean_square) const
{
  const double a = p[0], b = p[1], c = p[2];
  const double predicted = a * u + b * v + c * n;
  mean = (w - predicted) / n;
  const double cross = a * uw + b * vw + c * w;
  const double model =
      a * a * uu + b * b * vv + c * c * n + 2 * (a * b * uv + a * c * u + b * c * v);
  mean_square = std::max(0.0, (ww - 2 * cross + model) / n);
}

InverseDepthNoise::InverseDepthNoise(const SensorModel& sensor)
{
  // through three points, which is exact
  const auto sigma = [&](double w) { return sensor.sigmaZ(1 / w) * w * w; };
  const double half = sigma(0.5), one = sigma(1), two = sigma(2);
  const double low = (one - half) / 0.5, high = (two - one) / 1.0;
  square = (high - low) / 1.5;
  linear = low - 1.5 * square;
  constant = one - linear - square;
}

InverseDepthNoise
InverseDepthNoise::operator*(double factor) const
{
  InverseDepthNoise result;
  result.constant = factor * constant;
  result.linear = factor * linear;
  result.square = factor * square;
  return result;
}

} // namespace detail
} // namespace hoist
