#include <hoist/segmentation/cuboid_refinement.h>

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
constexpr double lateral_noise = 0.8; // of an outline element [px]
constexpr int max_face_pixels = 700;

struct FacePixel {
  Eigen::Vector3d point; // [m]
  int face;              // of the box
  double sigma;          // along the normal [m]
};

struct OutlinePoint {
  Eigen::Vector3d point;           // [m]
  int end;                         // of the box, lower 0, upper 0, lower 1, ...
  double sigma;                    // along the end's axis [m]
  double start_sigma;              // the same while the ends are still rough [m]
  int face;                        // of the box, whose outline it belongs to
  Eigen::Vector2d inside, outside; // the pixels on both sides of it [px]
  bool on_plane;                   // moved onto the plane that carries the box
};

// Tukey's biweight of a residual in units of sigma, zero beyond c.
double
weight(double r, double c)
{
  const double t = r / c;
  return std::abs(t) < 1 ? (1 - t * t) * (1 - t * t) : 0;
}

// Weighted sums over the residuals a . x - end of one box face, from which its share of
// the normal equations follows: cheaper than nine by nine products for each pixel.
struct Sums {
  Eigen::Matrix3d xx = Eigen::Matrix3d::Zero(); // only the lower half is summed up
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  Eigen::Vector3d xr = Eigen::Vector3d::Zero();
  double one = 0, r = 0;

  // n: how many measurements it counts for; cut: where the robust weight ends
  void
  add(const Eigen::Vector3d& a,
      double end,
      const Eigen::Vector3d& point,
      double sigma,
      double n,
      double cut)
  {
    const double residual = a.dot(point) - end;
    const double inverse = 1 / sigma;
    const double w = weight(residual * inverse, cut) * n * inverse * inverse;
    if (w == 0)
      return;
    const Eigen::Vector3d wx = w * point;
    for (int j = 0; j < 3; ++j)
      for (int i = j; i < 3; ++i)
        xx(i, j) += wx[i] * point[j];
    x += wx;
    xr += wx * residual;
    one += w;
    r += w * residual;
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

// Where the pixels of an outline do not contradict each other, the end lies between the
// last one on the face and the first one beyond it: finer than a pixel on a slanted
// edge. Any end in between gives the same pixels, so the middle is taken.
void
settleBetweenPixels(const std::vector<OutlinePoint>& outline,
                    const Intrinsics& camera,
                    double pixel,
                    CuboidHypothesis& h)
{
  struct Interval {
    double last = -std::numeric_limits<double>::infinity();
    double first = std::numeric_limits<double>::infinity();
    int points = 0;
    bool planes = false; // better known than by pixels
  };
  std::array<Interval, 6> intervals;
  for (const OutlinePoint& p : outline) {
    Interval& in = intervals[p.end];
    in.planes |= p.on_plane;
    const int axis = p.end / 2, across = 3 - p.face / 2 - axis;
    const auto lift = [&](const Eigen::Vector2d& q) -> Eigen::Vector3d {
      const Eigen::Vector3d ray = h.axes.transpose() * camera.ray(q.x(), q.y());
      return ray * (h.end(p.face) / ray[p.face / 2]);
    };
    const double side = CuboidHypothesis::side(p.end);
    in.last = std::max(in.last, side * lift(p.inside)[axis]);
    const Eigen::Vector3d beyond = lift(p.outside);
    // near the corner it may lie beyond another end as well, and says nothing then
    const double margin = 1.5 * pixel;
    if (beyond[across] < h.lower[across] + margin ||
        beyond[across] > h.upper[across] - margin)
      continue;
    in.first = std::min(in.first, side * beyond[axis]);
    ++in.points;
  }
  for (int g = 0; g < 6; ++g) {
    const Interval& in = intervals[g];
    constexpr int min_points = 6;
    const double side = CuboidHypothesis::side(g);
    if (!in.planes && in.points >= min_points && in.last < in.first)
      h.end(g) = side * (in.last + in.first) / 2;
  }
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
  std::vector<FacePixel> pixels;
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
    pixels.push_back({p, f, sigma});
    const int label = labels(v, u);
    if (label == 0)
      continue;
    auto it = std::find_if(
        votes.begin(), votes.end(), [&](const auto& x) { return x[0] == label; });
    if (it == votes.end())
      it = votes.insert(votes.end(), {label, 0, 0, 0, 0, 0, 0});
    ++(*it)[1 + f];
  }
  if (pixels.size() < 12)
    return false;

  // Outline elements of those labels, each with the end it lies at.
  std::vector<OutlinePoint> outline;
  for (const auto& vote : votes) {
    const int f = static_cast<int>(std::max_element(vote.begin() + 1, vote.end()) -
                                   vote.begin()) -
                  1;
    if (vote[1 + f] < 5)
      continue;
    const int label = vote[0] - 1;
    std::array<double, 3> step{}; // what a pixel is worth along each axis [m]
    for (int i = 0; i < 3; ++i)
      step[i] = footprint(faces[label], h.axes.col(i), camera);
    for (int i = borders.first[label]; i < borders.first[label + 1]; ++i) {
      const BorderElement& e = borders.elements[i];
      if (e.kind == BorderKind::occluded || e.kind == BorderKind::cut)
        continue;
      const Eigen::Vector3d local = h.axes.transpose() * e.point.cast<double>();
      const Eigen::Vector3d outward = e.outward.cast<double>();
      int end = -1;
      double nearest = 1; // in units of the reach
      for (int g = 0; g < 6; ++g) {
        // ends at visible faces are where two planes meet: the pixels know them better
        if (g / 2 == f / 2 || evidence.visible[g])
          continue;
        const double reach = 1.5 * step[g / 2] + 0.5 * noise;
        const double d = std::abs(local[g / 2] - h.end(g)) / reach;
        if (d < nearest && h.outward(g).dot(outward) >= 0.3) {
          nearest = d;
          end = g;
        }
      }
      if (end < 0)
        continue;
      const double lateral = lateral_noise * step[end / 2];
      // which way the pixel's side looks
      const Eigen::Vector2d pixel = e.pixel.cast<double>();
      const Eigen::Vector2d ahead =
          camera.project(e.point.cast<double>() + 1e-3 * z * outward) - pixel;
      const Eigen::Vector2d half = pixel.x() != std::floor(pixel.x())
                                       ? Eigen::Vector2d(ahead.x() > 0 ? 0.5 : -0.5, 0)
                                       : Eigen::Vector2d(0, ahead.y() > 0 ? 0.5 : -0.5);
      OutlinePoint point{e.point.cast<double>(),
                         end,
                         lateral,
                         lateral,
                         f,
                         pixel - half,
                         pixel + half,
                         false};
      // Where the box stands on something, the two planes say better than the pixels
      // where the face ends.
      const Eigen::Vector3d axis = h.outward(end);
      if (e.kind == BorderKind::crease && e.neighbour >= 0 &&
          faces[e.neighbour].normal.dot(axis) < -0.96) {
        const PlanarFace& support = faces[e.neighbour];
        const double t = -(support.normal.dot(point.point) + support.offset) /
                         support.normal.dot(axis);
        if (std::abs(t) < 2 * step[end / 2] + noise) {
          point.point += t * axis;
          point.sigma = 0.5 * noise;
          point.on_plane = true;
        }
      }
      outline.push_back(point);
    }
  }

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
    for (const FacePixel& p : pixels)
      sums[p.face].add(axes.col(p.face / 2),
                       ends[3 + p.face],
                       p.point - origin,
                       p.sigma,
                       share / face_correlation,
                       4.7);
    for (const OutlinePoint& p : outline)
      sums[p.end].add(axes.col(p.end / 2),
                      ends[3 + p.end],
                      p.point - origin,
                      iteration < rough_iterations ? p.start_sigma : p.sigma,
                      1 / border_correlation,
                      3.0);
    for (int f = 0; f < 6; ++f)
      sums[f].addTo(normal, gradient, axes.col(f / 2), f);
    // what nothing measures stays where the hypothesis put it
    for (int f = 0; f < 6; ++f) {
      // an end on a support is as good as the support's plane; a seen one is where its
      // pixels piled up, should none of them be in reach now
      double prior = 1.0; // [m]
      if (h.ends[f] == EndSource::support)
        prior = noise;
      else if (h.ends[f] == EndSource::bracketed) // even over the interval
        prior = h.room[f] / std::sqrt(12.0);
      else if (h.ends[f] != EndSource::bound)
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
    if (iteration >= rough_iterations && delta.norm() < 1e-6)
      break;
  }
  // clean up rounding
  axes.col(0).normalize();
  axes.col(1) = (axes.col(1) - axes.col(0) * axes.col(0).dot(axes.col(1))).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));

  h.axes = axes;
  for (int f = 0; f < 6; ++f)
    h.end(f) = ends[3 + f] + axes.col(f / 2).dot(origin);
  settleBetweenPixels(outline, camera, pixel, h);
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
