#include <hoist/segmentation/line_lift.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace hoist {
namespace {

Eigen::Vector3d
toEigen(const cv::Vec3f& p)
{
  return {p[0], p[1], p[2]};
}

// The pixel with a point that is nearest to (u, v), within radius.
bool
nearestPoint(const FrameImages& images,
             int u,
             int v,
             int radius,
             Eigen::Vector3d& point)
{
  int best = radius * radius + 1;
  float best_inverse = 0;
  for (int dv = -radius; dv <= radius; ++dv)
    for (int du = -radius; du <= radius; ++du) {
      const int x = u + du, y = v + dv, d = du * du + dv * dv;
      if (d > best || d > radius * radius || x < 0 || y < 0 || x >= images.width() ||
          y >= images.height())
        continue;
      const float inverse = images.inverse_depth(y, x);
      if (inverse > 0 && (d < best || inverse > best_inverse)) {
        best = d;
        best_inverse = inverse;
        point = toEigen(images.points(y, x));
      }
    }
  return best_inverse > 0;
}

// One measured pixel beside a segment: along, across [px], inverse depth [1/m].
struct Sample {
  double t, s, q;
};

// q = a + b t + c s of one side, and how well it is known where s = 0.
struct Side {
  bool valid = false;
  Eigen::Vector3d abc = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double squares = 0; // weighted sum of squared residuals, in units of 1/m^2
  double weight = 0;
  double
  inverseDepth(double t) const
  {
    return abc[0] + abc[1] * t;
  }
  double
  variance(double t) const
  {
    const Eigen::Vector3d x(1, t, 0);
    return x.dot(covariance * x);
  }
};

double
median(std::vector<double>& values)
{
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Tukey's resistant line through the medians of the first and the last third.
Eigen::Vector3d
resistantLine(const std::vector<Sample>& samples)
{
  const std::size_t third = std::max<std::size_t>(1, samples.size() / 3);
  const auto middle = [&](std::size_t first, double Sample::*member) {
    std::vector<double> values;
    for (std::size_t i = first; i < first + third; ++i)
      values.push_back(samples[i].*member);
    return median(values);
  };
  const std::size_t last = samples.size() - third;
  const double t0 = middle(0, &Sample::t), t1 = middle(last, &Sample::t);
  const double q0 = middle(0, &Sample::q), q1 = middle(last, &Sample::q);
  const double slope = t1 > t0 ? (q1 - q0) / (t1 - t0) : 0;
  return {q0 - slope * t0, slope, 0};
}

// Reweighted least squares; samples are ordered along t.
Side
fitSide(const std::vector<Sample>& samples, const SensorModel& sensor)
{
  constexpr int iterations = 12;
  constexpr double tukey = 4.685; // 95 % efficiency under normal noise
  constexpr double min_share = 0.5;
  Side side;
  const auto n = static_cast<Eigen::Index>(samples.size());
  if (n < 12)
    return side;
  Eigen::MatrixX3d design(n, 3);
  Eigen::VectorXd q(n), sigma(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    design.row(i) << 1, samples[i].t, samples[i].s;
    q[i] = samples[i].q;
    // first order: q = 1/z
    sigma[i] = std::max(sensor.sigmaZ(1 / q[i]), 1e-6) * q[i] * q[i];
  }
  side.abc = resistantLine(samples);
  Eigen::VectorXd weight(n);
  for (int i = 0; i < iterations; ++i) {
    const Eigen::VectorXd r = ((q - design * side.abc).array() / sigma.array()).abs();
    std::vector<double> copy(r.data(), r.data() + n);
    // the start ignores the slope across, so the scale shrinks from what it leaves
    const double scale = tukey * std::max(1.0, 1.4826 * median(copy));
    weight = (r.array() < scale).select((1 - (r.array() / scale).square()).square(), 0);
    const Eigen::VectorXd w = weight.array() / sigma.array().square();
    const Eigen::Matrix3d normal = design.transpose() * w.asDiagonal() * design;
    const Eigen::LDLT<Eigen::Matrix3d> solver(normal);
    if (solver.info() != Eigen::Success || !solver.isPositive() ||
        solver.vectorD().minCoeff() <= 0)
      return side;
    side.abc = solver.solve(design.transpose() * w.asDiagonal() * q);
    side.covariance = solver.solve(Eigen::Matrix3d::Identity());
  }
  const Eigen::VectorXd r = q - design * side.abc;
  const double inliers =
      static_cast<double>((r.array().abs() < 4 * sigma.array()).count());
  side.squares = (weight.array() * r.array().square()).sum();
  side.weight = weight.sum();
  side.valid = side.abc.allFinite() && inliers >= min_share * static_cast<double>(n);
  return side;
}

// Where the surfaces of both sides meet.
struct Joint {
  enum Kind { step, crease, flat };
  Kind kind = step;
  std::array<double, 2> inverse_depth{}; // at both ends
  std::array<double, 2> shift{};         // of both ends across the segment [px]
};

Joint
joinSides(const std::array<Side, 2>& sides, double length)
{
  constexpr double max_shift = 2.0; // [px]; an edge pixel is not farther off
  Joint joint;
  const double tilt = sides[0].abc[2] - sides[1].abc[2];
  const double tilt_sigma =
      std::sqrt(sides[0].covariance(2, 2) + sides[1].covariance(2, 2));
  bool crease = std::abs(tilt) > 3 * tilt_sigma;
  bool flat = true;
  std::array<double, 2> flat_depth{};
  for (int k = 0; k < 2; ++k) {
    const double t = k == 0 ? 0 : length;
    const double q0 = sides[0].inverseDepth(t), q1 = sides[1].inverseDepth(t);
    const double v0 = sides[0].variance(t), v1 = sides[1].variance(t);
    flat = flat && std::abs(q0 - q1) <= 3 * std::sqrt(v0 + v1);
    flat_depth[k] = (q0 / v0 + q1 / v1) / (1 / v0 + 1 / v1);
    if (crease) {
      joint.shift[k] = -(q0 - q1) / tilt;
      joint.inverse_depth[k] = q0 + sides[0].abc[2] * joint.shift[k];
      crease = std::abs(joint.shift[k]) <= max_shift;
    }
  }
  if (crease) {
    joint.kind = Joint::crease;
    return joint;
  }
  joint.shift = {0, 0};
  joint.inverse_depth = flat_depth;
  joint.kind = flat ? Joint::flat : Joint::step;
  return joint;
}

} // namespace

const char*
toString(LiftStatus status)
{
  switch (status) {
  case LiftStatus::lifted:
    return "";
  case LiftStatus::no_depth:
    return "segment without depth";
  case LiftStatus::no_camera:
    return "segment without a camera";
  case LiftStatus::not_straight:
    return "segment not straight in space";
  case LiftStatus::degenerate:
    return "segment of no length";
  }
  return "";
}

LiftStatus
liftEndpoints(const FrameImages& images,
              const PixelSegment& segment,
              int search_radius,
              LineSegment& line)
{
  std::array<Eigen::Vector3d, 2> points;
  for (int k = 0; k < 2; ++k) {
    const Eigen::Vector2f& pixel = segment.pixels[k];
    if (!nearestPoint(images,
                      cvRound(pixel.x()),
                      cvRound(pixel.y()),
                      std::max(0, search_radius),
                      points[k]))
      return LiftStatus::no_depth;
  }
  if (points[0] == points[1])
    return LiftStatus::degenerate;
  line.pixels = segment.pixels;
  line.points = points;
  line.sigma = 0;
  return LiftStatus::lifted;
}

LiftStatus
liftRobust(const FrameImages& images,
           const PixelSegment& segment,
           const SensorModel& sensor,
           int strip,
           LineSegment& line)
{
  if (!images.intrinsics.valid())
    return LiftStatus::no_camera;
  const Eigen::Vector2d origin = segment.pixels[0].cast<double>();
  const Eigen::Vector2d run = segment.pixels[1].cast<double>() - origin;
  const double length = run.norm();
  if (!(length > 0))
    return LiftStatus::degenerate;
  const Eigen::Vector2d along = run / length, across(-along.y(), along.x());
  // corners belong to other surfaces too
  const double margin = length > 12 ? 2 : 0;

  std::array<std::vector<Sample>, 2> samples;
  for (double t = margin; t <= length - margin; t += 1)
    for (int side = 0; side < 2; ++side)
      for (int s = 1; s <= strip; ++s) {
        const Eigen::Vector2d at = origin + t * along + (side == 0 ? s : -s) * across;
        const int u = cvRound(at.x()), v = cvRound(at.y());
        if (u < 0 || v < 0 || u >= images.width() || v >= images.height())
          continue;
        const float q = images.inverse_depth(v, u);
        const Eigen::Vector2d pixel = Eigen::Vector2d(u, v) - origin;
        if (q > 0)
          samples[side].push_back({pixel.dot(along), pixel.dot(across), q});
      }
  if (samples[0].size() < 12 && samples[1].size() < 12)
    return LiftStatus::no_depth;

  std::array<Side, 2> sides = {fitSide(samples[0], sensor),
                               fitSide(samples[1], sensor)};
  if (!sides[0].valid && !sides[1].valid)
    return LiftStatus::not_straight;
  const bool two = sides[0].valid && sides[1].valid;
  const Joint joint = two ? joinSides(sides, length) : Joint();
  const bool both = joint.kind != Joint::step;
  const int nearer =
      !sides[0].valid || (sides[1].valid && sides[1].inverseDepth(length / 2) >
                                                sides[0].inverseDepth(length / 2))
          ? 1
          : 0;

  std::array<Eigen::Vector3d, 2> points;
  std::array<Eigen::Vector2f, 2> pixels = segment.pixels;
  for (int k = 0; k < 2; ++k) {
    double q = sides[nearer].inverseDepth(k == 0 ? 0 : length);
    if (both) {
      q = joint.inverse_depth[k];
      pixels[k] += (joint.shift[k] * across).cast<float>();
    }
    if (!(q > 0))
      return LiftStatus::not_straight;
    points[k] = images.intrinsics.ray(pixels[k].x(), pixels[k].y()) / q;
  }
  double squares = sides[nearer].squares, weight = sides[nearer].weight;
  if (both) {
    squares = sides[0].squares + sides[1].squares;
    weight = sides[0].weight + sides[1].weight;
  }
  const double z = 0.5 * (points[0].z() + points[1].z());
  line.pixels = pixels;
  line.points = points;
  line.sigma = std::sqrt(squares / weight) * z * z; // dz = z^2 dq
  return LiftStatus::lifted;
}

} // namespace hoist
