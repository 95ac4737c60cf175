#include "refinement_outline.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hoist {
namespace {

using Vector9 = Eigen::Matrix<double, 9, 1>;
using Matrix9 = Eigen::Matrix<double, 9, 9>;

// Neighbouring measurements share their errors: so many of them count as one.
constexpr double face_correlation = 50;
constexpr double border_correlation = 6;
constexpr int max_face_pixels = 700;

// Tukey's biweight of a residual in units of sigma, zero beyond c.
double
weight(double r, double c)
{
  const double t = r / c;
  return std::abs(t) < 1 ? (1 - t * t) * (1 - t * t) : 0;
}

// A point on a face or at an end of the box.
struct Measurement {
  Eigen::Vector3d point; // from the origin of the turns [m]
  double inverse;        // 1 / sigma along the normal [1/m]
  double start_inverse;  // the same while the ends are still rough
};

// Measurements, those of one face or end of the box after the other.
class Measurements {
public:
  void
  add(int f, const Measurement& m)
  {
    unsorted_.push_back({f, m});
    ++first_[f + 1];
  }

  void
  sort()
  {
    for (int f = 0; f < 6; ++f)
      first_[f + 1] += first_[f];
    std::array<int, 7> next = first_;
    sorted_.resize(unsorted_.size());
    for (const auto& [f, m] : unsorted_)
      sorted_[next[f]++] = m;
  }

  const Measurement*
  begin(int f) const
  {
    return sorted_.data() + first_[f];
  }
  const Measurement*
  end(int f) const
  {
    return sorted_.data() + first_[f + 1];
  }

private:
  std::array<int, 7> first_{};
  std::vector<std::pair<int, Measurement>> unsorted_;
  std::vector<Measurement> sorted_;
};

// Weighted sums over the residuals a . x - end of one box face, from which its share of
// the normal equations follows: cheaper than nine by nine products for each pixel.
struct Sums {
  Eigen::Matrix3d xx = Eigen::Matrix3d::Zero(); // only the lower half is summed up
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  Eigen::Vector3d xr = Eigen::Vector3d::Zero();
  double one = 0, r = 0;

  // count: how many measurements each stands for; cut: where the robust weight ends
  void
  add(const Measurement* first,
      const Measurement* last,
      const Eigen::Vector3d& a,
      double end,
      bool rough,
      double count,
      double cut)
  {
    Sums sum = *this; // in registers
    for (const Measurement* m = first; m != last; ++m) {
      const double residual = a.dot(m->point) - end;
      const double inverse = rough ? m->start_inverse : m->inverse;
      const double w = weight(residual * inverse, cut) * count * inverse * inverse;
      const Eigen::Vector3d wx = w * m->point;
      for (int j = 0; j < 3; ++j)
        for (int i = j; i < 3; ++i)
          sum.xx(i, j) += wx[i] * m->point[j];
      sum.x += wx;
      sum.xr += wx * residual;
      sum.one += w;
      sum.r += w * residual;
    }
    *this = sum;
  }

  // d(a . x) for a turn omega is omega . (a x x); for the end it is -1.
  void
  addTo(Matrix9& normal, Vector9& gradient, const Eigen::Vector3d& a, int f) const
  {
    Eigen::Matrix3d cross;
    cross << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
    const Eigen::Matrix3d full = xx.selfadjointView<Eigen::Lower>();
    normal.topLeftCorner<3, 3>() += cross * full * cross.transpose();
    const Eigen::Vector3d turn = cross * x;
    normal.block<3, 1>(0, 3 + f) -= turn;
    normal.block<1, 3>(3 + f, 0) -= turn.transpose();
    normal(3 + f, 3 + f) += one;
    gradient.head<3>() += cross * xr;
    gradient[3 + f] -= r;
  }
};

// The box face that a point near the surface lies on, or -1.
int
faceOf(const CuboidHypothesis& h,
       const CuboidEvidence& e,
       const Eigen::Vector3d& local,
       double gate)
{
  int best = -1;
  double nearest = gate;
  for (int f = 0; f < 6; ++f) {
    if (!e.visible[f])
      continue;
    const double d = std::abs(local[f / 2] - h.end(f));
    if (d < nearest) {
      nearest = d;
      best = f;
    }
  }
  return best;
}

} // namespace

bool
refineCuboid(CuboidHypothesis& hypothesis,
             const CuboidEvidence& evidence,
             const cv::Mat1f& image,
             const cv::Mat1s& labels,
             const std::vector<PlanarFace>& faces,
             const FaceBorders& borders,
             const Intrinsics& camera,
             const SensorModel& sensor,
             CuboidCovariance& covariance)
{
  CuboidHypothesis h = hypothesis;
  const Eigen::Vector3d origin = h.center();
  const double z = origin.z();
  const double pixel = z / std::min(camera.fx, camera.fy);
  const double noise = sensor.sigmaZ(z);

  // Face pixels: an even subset of the support. Which labels lie on which box face?
  Measurements pixels;
  int n_pixels = 0;
  std::vector<std::array<int, 7>> votes; // label, then count per face
  const std::size_t every =
      std::max<std::size_t>(1, evidence.support.size() / max_face_pixels);
  const double share = static_cast<double>(evidence.stride) * evidence.stride * every;
  for (std::size_t i = 0; i < evidence.support.size(); i += every) {
    const int index = evidence.support[i];
    const int u = index % image.cols, v = index / image.cols;
    const Eigen::Vector3d ray = camera.ray(u, v);
    const Eigen::Vector3d p = ray / image(v, u);
    const int f = faceOf(h, evidence, h.axes.transpose() * p, 5 * noise + 3 * pixel);
    if (f < 0)
      continue;
    const double cosine = std::abs(h.axes.col(f / 2).dot(ray));
    const double sigma = sensor.sigmaZ(p.z()) * std::max(cosine, 0.1);
    pixels.add(f, {p - origin, 1 / sigma, 1 / sigma});
    ++n_pixels;
    const int label = labels(v, u);
    if (label == 0)
      continue;
    auto it = std::find_if(
        votes.begin(), votes.end(), [&](const auto& x) { return x[0] == label; });
    if (it == votes.end())
      it = votes.insert(votes.end(), {label, 0, 0, 0, 0, 0, 0});
    ++(*it)[1 + f];
  }
  constexpr int min_pixels = 12;
  if (n_pixels < min_pixels)
    return false;
  pixels.sort();

  // Outline elements of those labels, each with the end it lies at.
  std::vector<detail::OutlinePoint> outline;
  for (const auto& vote : votes) {
    const int f = static_cast<int>(std::max_element(vote.begin() + 1, vote.end()) -
                                   vote.begin()) -
                  1;
    if (vote[1 + f] < 5)
      continue;
    detail::addOutline(
        h, evidence, vote[0] - 1, f, faces, borders, camera, noise, outline);
  }

  Measurements outlines;
  for (const detail::OutlinePoint& p : outline)
    outlines.add(p.end, {p.point - origin, 1 / p.sigma, 1 / p.start_sigma});
  outlines.sort();

  // Parameters: turn about the origin, then the six ends measured from the origin.
  Vector9 ends = Vector9::Zero();
  const auto fromOrigin = [&](int f) {
    return h.end(f) - h.axes.col(f / 2).dot(origin);
  };
  for (int f = 0; f < 6; ++f)
    ends[3 + f] = fromOrigin(f);
  const Vector9 start = ends;
  Eigen::Matrix3d axes = h.axes;
  Matrix9 normal;
  std::array<Sums, 6> sums;
  constexpr int iterations = 6, rough_iterations = 3;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    normal.setZero();
    Vector9 gradient = Vector9::Zero();
    for (Sums& sum : sums)
      sum = Sums();
    const bool rough = iteration < rough_iterations;
    for (int f = 0; f < 6; ++f) {
      const Eigen::Vector3d axis = axes.col(f / 2);
      const double end = ends[3 + f];
      constexpr double face_cut = 4.7, outline_cut = 3.0; // [sigma]
      sums[f].add(pixels.begin(f),
                  pixels.end(f),
                  axis,
                  end,
                  rough,
                  share / face_correlation,
                  face_cut);
      sums[f].add(outlines.begin(f),
                  outlines.end(f),
                  axis,
                  end,
                  rough,
                  1 / border_correlation,
                  outline_cut);
      sums[f].addTo(normal, gradient, axis, f);
    }
    // what nothing measures stays where the hypothesis put it
    for (int f = 0; f < 6; ++f) {
      // an end on a support is as good as the support's plane; a seen one is where its
      // pixels piled up, should none of them be in reach now
      double prior = 1.0; // [m]
      if (h.ends[f] == EndSource::support)
        prior = noise;
      else if (h.ends[f] == EndSource::bracketed ||
               h.ends[f] == EndSource::catalogue) // even over the interval
        prior = h.room[f] / std::sqrt(12.0);
      else if (h.ends[f] != EndSource::bound && h.ends[f] != EndSource::unknown)
        prior = 4 * pixel + noise;
      normal(3 + f, 3 + f) += 1 / (prior * prior);
      gradient[3 + f] += (ends[3 + f] - start[3 + f]) / (prior * prior);
    }
    for (int i = 0; i < 3; ++i)
      normal(i, i) += 1; // 1 rad
    const Vector9 delta = -normal.ldlt().solve(gradient);
    if (!delta.allFinite() || delta.head<3>().norm() > 0.3)
      return false;
    const double angle = delta.head<3>().norm();
    if (angle > 1e-12)
      axes =
          Eigen::AngleAxisd(angle, delta.head<3>() / angle).toRotationMatrix() * axes;
    ends.tail<6>() += delta.tail<6>();
    constexpr double small = 1e-6; // [rad], [m]
    if (iteration >= rough_iterations && delta.norm() < small)
      break;
  }
  // clean up rounding
  axes.col(0).normalize();
  axes.col(1) = (axes.col(1) - axes.col(0) * axes.col(0).dot(axes.col(1))).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));

  h.axes = axes;
  for (int f = 0; f < 6; ++f)
    h.end(f) = ends[3 + f] + axes.col(f / 2).dot(origin);
  detail::settleBetweenPixels(outline, camera, pixel, h);
  for (int f = 0; f < 6; ++f) // a given length is measured from the other end
    if (h.ends[f] == EndSource::catalogue || h.ends[f] == EndSource::unknown)
      h.end(f) = h.end(f ^ 1) + CuboidHypothesis::side(f) * h.given[f / 2];
  if ((h.size().array() <= 0).any() ||
      (h.center() - origin).norm() > 0.5 * h.size().norm())
    return false;

  const Matrix9 c = normal.ldlt().solve(Matrix9::Identity());
  Eigen::Matrix3d center = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const double ll = c(3 + 2 * i, 3 + 2 * i), uu = c(4 + 2 * i, 4 + 2 * i);
    const double lu = c(3 + 2 * i, 4 + 2 * i);
    covariance.size[i] = std::sqrt(std::max(0.0, ll + uu - 2 * lu));
    for (int j = 0; j < 3; ++j) {
      const double cij = 0.25 * (c(3 + 2 * i, 3 + 2 * j) + c(3 + 2 * i, 4 + 2 * j) +
                                 c(4 + 2 * i, 3 + 2 * j) + c(4 + 2 * i, 4 + 2 * j));
      center += cij * axes.col(i) * axes.col(j).transpose();
    }
  }
  covariance.center = center.diagonal().cwiseMax(0.0).cwiseSqrt();
  covariance.rotation = std::sqrt(c.topLeftCorner<3, 3>().trace());
  hypothesis = h;
  return true;
}

} // namespace hoist
