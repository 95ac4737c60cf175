#include <hoist/simulation/measure.h>

#include "noise.h"
#include <hoist/simulation/random.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hoist {
namespace simulation {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr double half_pi = 1.5707963267948966;

// Abramowitz and Stegun 4.4.45, to 7e-5; the C library's differs between processors.
double
arcCosine(double x)
{
  const double a = std::clamp(x, 0.0, 1.0);
  return std::sqrt(1 - a) *
         (1.5707288 + a * (-0.2121144 + a * (0.0742610 - 0.0187293 * a)));
}

// Blotches: even in [0, 1) and alike over a few pixels, as what a matching window does.
double
blotch(int u, int v, double size, std::uint64_t seed)
{
  const double smooth = latticeNoise({u / size, v / size, 0.5}, seed);
  // interpolated noise crowds around its mean: spread again
  const double even = std::clamp((smooth - 0.5) * 1.6 + 0.5, 0.0, 1.0);
  return 0.7 * even + 0.3 * hash01(seed, u, v);
}

class Meter {
public:
  Meter(const RayCaster& caster,
        const Scene& scene,
        const Layer& layer,
        const Lens& lens)
  : caster_(caster)
  , scene_(scene)
  , sensor_(scene.sensor)
  , layer_(layer)
  , lens_(lens)
  , seed_(subSeed(scene.seed, "depth"))
  {
    if (sensor_.kind == SensorKind::kinect) {
      // a pixel more on every side, for the neighbourhoods of those at the border
      grain_.create(layer.depth.rows + 2, layer.depth.cols + 2);
      for (int v = 0; v < grain_.rows; ++v)
        for (int u = 0; u < grain_.cols; ++u)
          grain_(v, u) = static_cast<float>(hashNormal(seed_ + 21, u, v));
      inverse_.create(layer.depth.size());
      for (int v = 0; v < inverse_.rows; ++v)
        for (int u = 0; u < inverse_.cols; ++u)
          inverse_(v, u) =
              layer.depth(v, u) > 0 ? static_cast<float>(1 / layer.depth(v, u)) : 0.0f;
      nearest_ = 1.05 * *std::max_element(inverse_.begin(), inverse_.end());
    }
  }

  float
  depth(int u, int v) const
  {
    if (sensor_.kind == SensorKind::ideal || sensor_.kind == SensorKind::stereo)
      return inRange(layer_.depth(v, u));
    const bool kinect = sensor_.kind == SensorKind::kinect;
    const bool edge = onJump(u, v);
    int x = u, y = v;
    if (kinect && sensor_.lateral > 0)
      wander(x, y);
    double z = depthThrough(u, v, x, y);
    if (!(z > 0))
      return nan;
    if (lost(u, v, x, y, edge))
      return nan;
    if (kinect && sensor_.baseline != 0 && inShadow(x, y))
      return nan;
    if (!kinect && edge)
      z = mixedDepth(u, v, z);
    const double sigma = sigmaZ(sensor_, z, layer_.cosine(y, x));
    return inRange(kinect ? kinectDepth(u, v, z, sigma)
                          : tofDepth(u, v, x, y, z, sigma));
  }

private:
  float
  inRange(double z) const
  {
    return z >= sensor_.min_range && z <= sensor_.max_range ? static_cast<float>(z)
                                                            : nan;
  }

  bool
  inside(int x, int y) const
  {
    return x >= 0 && y >= 0 && x < layer_.depth.cols && y < layer_.depth.rows;
  }

  // The outline of things wanders by the lateral noise, in waves of some pixels.
  void
  wander(int& x, int& y) const
  {
    const auto shift = [&](std::uint64_t salt) {
      // the wave's standard deviation is 0.16 before scaling
      const double wave =
          (latticeNoise({x / 4.0, y / 4.0, 0.5}, seed_ + salt) - 0.5) / 0.16;
      return static_cast<int>(std::floor(
          sensor_.lateral * (0.8 * wave + 0.6 * hashNormal(seed_ + salt, x, y)) + 0.5));
    };
    const int dx = shift(1), dy = shift(2);
    x = std::clamp(x + dx, 0, layer_.depth.cols - 1);
    y = std::clamp(y + dy, 0, layer_.depth.rows - 1);
  }

  // Depth of the surface that pixel (x, y) sees, on the ray of (u, v): a slanted
  // surface does not get rough because its edge is.
  double
  depthThrough(int u, int v, int x, int y) const
  {
    const double z = layer_.depth(y, x);
    if ((x == u && y == v) || !(z > 0))
      return z;
    const cv::Vec3f& n = layer_.normal(y, x);
    const Eigen::Vector3d normal(n[0], n[1], n[2]);
    const double slope = normal.dot(lens_.ray(u, v));
    if (slope > -0.05)
      return z;
    const double moved = z * normal.dot(lens_.ray(x, y)) / slope;
    return std::abs(moved - z) < 0.1 * z ? moved : z;
  }

  bool
  onJump(int u, int v) const
  {
    const double z = layer_.depth(v, u);
    for (const auto& d : {std::array<int, 2>{{1, 0}},
                          {{-1, 0}},
                          {{0, 1}},
                          {{0, -1}},
                          {{2, 0}},
                          {{-2, 0}}}) {
      const int x = u + d[0], y = v + d[1];
      if (!inside(x, y))
        continue;
      const double other = layer_.depth(y, x);
      if (!(std::abs(other - z) < 0.02 + 0.015 * z))
        return true;
    }
    return false;
  }

  bool
  lost(int u, int v, int x, int y, bool edge) const
  {
    if (edge && blotch(u, v, 2.5, seed_ + 11) < sensor_.edge_loss)
      return true;
    const double cosine = layer_.cosine(y, x);
    if (cosine < 0.42) { // 65 degrees; 80 degrees are 0.17
      const double share =
          sensor_.grazing_loss * std::clamp((0.42 - cosine) / 0.25, 0.0, 1.6);
      if (blotch(u, v, 5, seed_ + 12) < share)
        return true;
    }
    const Thing& thing = scene_.things[static_cast<std::size_t>(layer_.thing(y, x))];
    const Material& material = thing.materials.front();
    double share = 0;
    if (material.metal && material.gloss > 0.4)
      share = 0.25; // mirrors throw the pattern elsewhere
    if (linear(material.color).maxCoeff() < 0.02f)
      share = std::max(share, 0.3);
    return share > 0 && sensor_.grazing_loss > 0 && blotch(u, v, 6, seed_ + 13) < share;
  }

  // The way to the projector stays in the pixel's row and comes nearer by a disparity
  // per column. It is free if all that is seen there lies behind it; else a ray tells.
  bool
  mayBeShadowed(int x, int y) const
  {
    const double per_column = 1 / (sensor_.camera.fx * sensor_.baseline);
    if (sensor_.baseline < 0 || sensor_.distortion != std::array<double, 5>{})
      return true;
    const double own = inverse_(y, x);
    for (int u = x + 1; u < inverse_.cols; ++u) {
      const double line = own + (u - x) * per_column;
      if (line > nearest_)
        return false;
      if (inverse_(y, u) > line - 0.5 * per_column)
        return true;
    }
    return true; // what is beyond the border is not seen
  }

  bool
  inShadow(int x, int y) const
  {
    if (!mayBeShadowed(x, y))
      return false;
    const Eigen::Vector3d p = layer_.depth(y, x) * lens_.ray(x, y);
    const cv::Vec3f& n = layer_.normal(y, x);
    const Eigen::Vector3d start = p + Eigen::Vector3d(n[0], n[1], n[2]) * 1e-3 * p.z();
    const Eigen::Vector3d way = Eigen::Vector3d(sensor_.baseline, 0, 0) - start;
    return caster_.blocked(
        scene_.sensor_to_world * start, scene_.sensor_to_world.linear() * way, 0.999);
  }

  double
  kinectDepth(int u, int v, double z, double sigma) const
  {
    if (sigma <= 0)
      return z;
    // 0.8 of the error is shared by a 3 x 3 neighbourhood, 0.6 is the pixel's own
    double common = 0;
    for (int j = -1; j <= 1; ++j)
      for (int i = -1; i <= 1; ++i)
        common += grain_(v + 1 + j, u + 1 + i) / 3.0;
    const double error = 0.8 * common + 0.6 * hashNormal(seed_ + 22, u, v);
    const double focal_baseline = sensor_.focal_ir * std::abs(sensor_.baseline);
    if (sensor_.disparity_step <= 0 || focal_baseline <= 0)
      return z + sigma * error;
    // rounding is a part of sigma: what is added is the rest
    const double step = sensor_.disparity_step;
    const double to_disparity = focal_baseline / (z * z);
    const double total = sigma * to_disparity;
    const double added = std::sqrt(std::max(0.0, total * total - step * step / 12));
    const double disparity = focal_baseline / z + added * error;
    return focal_baseline / (std::floor(disparity / step + 0.5) * step);
  }

  // What falls on a pixel across a jump comes from both sides.
  double
  mixedDepth(int u, int v, double z) const
  {
    constexpr double offsets[4][2] = {
        {-0.4, -0.2}, {0.2, -0.4}, {0.4, 0.2}, {-0.2, 0.4}};
    double sum = z;
    int count = 1;
    for (const auto& offset : offsets) {
      const Hit hit = caster_.cast(scene_.sensor_to_world.translation(),
                                   scene_.sensor_to_world.linear() *
                                       lens_.ray(u + offset[0], v + offset[1]));
      if (hit.thing < 0)
        continue;
      sum += hit.distance;
      ++count;
    }
    return sum / count;
  }

  double
  tofDepth(int u, int v, int x, int y, double z, double sigma) const
  {
    const Thing& thing = scene_.things[static_cast<std::size_t>(layer_.thing(y, x))];
    const double echo =
        linear(thing.materials.front().color).mean() * layer_.cosine(y, x) / 0.25;
    const double weak = std::clamp(1 / std::sqrt(echo + 1e-3), 0.7, 3.0);
    return z + sigma * weak * hashNormal(seed_ + 31, u, v);
  }

  const RayCaster& caster_;
  const Scene& scene_;
  const Sensor& sensor_;
  const Layer& layer_;
  const Lens& lens_;
  std::uint64_t seed_;
  cv::Mat1f inverse_;  ///< of the depth [1/m], 0 for nothing
  double nearest_ = 0; ///< inverse depth that nothing in the picture exceeds [1/m]
  cv::Mat1f grain_;    ///< what neighbours share of the noise
};

} // namespace

double
sigmaZ(const Sensor& sensor, double z, double cosine)
{
  switch (sensor.kind) {
  case SensorKind::kinect: {
    const double t = std::min(arcCosine(cosine), 1.45);
    const double ratio = t / (half_pi - t);
    return sensor.noise * (0.0012 + 0.0019 * (z - 0.4) * (z - 0.4) +
                           0.0001 / std::sqrt(z) * ratio * ratio);
  }
  case SensorKind::tof:
    return sensor.noise * (sensor.sigma_constant + sensor.sigma_quadratic * z * z);
  case SensorKind::ideal:
  case SensorKind::stereo:
    break;
  }
  return 0;
}

cv::Mat1f
measureDepth(const RayCaster& caster,
             const Scene& scene,
             const Layer& layer,
             const Lens& lens)
{
  const Meter meter(caster, scene, layer, lens);
  cv::Mat1f depth(layer.depth.size());
  for (int v = 0; v < depth.rows; ++v)
    for (int u = 0; u < depth.cols; ++u)
      depth(v, u) = meter.depth(u, v);
  return depth;
}

} // namespace simulation
} // namespace hoist
