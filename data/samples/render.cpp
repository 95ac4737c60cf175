#include "render.h"

#include "random.h"
#include "raycast.h"
#include "texture.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hoist {
namespace samples {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

// A surface and its light.
Eigen::Vector3d
shade(const Scene& scene, const Eigen::Vector3d& direction, const Hit& hit)
{
  if (hit.object < 0)
    return Eigen::Vector3d::Constant(25);
  const auto boxes = static_cast<int>(scene.boxes.size());
  const auto cylinders = static_cast<int>(scene.cylinders.size());
  Rgb base;
  Texture texture;
  if (hit.object < boxes) {
    base = scene.boxes[hit.object].color;
    texture = scene.boxes[hit.object].texture;
  }
  else if (hit.object < boxes + cylinders) {
    base = scene.cylinders[hit.object - boxes].color;
    texture = scene.cylinders[hit.object - boxes].texture;
  }
  else {
    base = scene.patches[hit.object - boxes - cylinders].color;
    texture = scene.patches[hit.object - boxes - cylinders].texture;
  }
  const std::uint64_t seed = mix(scene.seed * 64 + hit.object) + 7 * hit.face;
  const Eigen::Vector3d color = albedo(texture, base, hit.s, hit.t, hit.half, seed);

  const Eigen::Vector3d light = scene.light.normalized();
  double lambert = std::max(0.0, hit.normal.dot(light));
  if (scene.shadows && lambert > 0) {
    const Eigen::Vector3d p = hit.distance * direction + 1e-5 * hit.normal;
    if (blocked(scene, p, p + 50.0 * light))
      lambert = 0;
  }
  const double shading = scene.ambient + (1 - scene.ambient) * lambert;
  return (shading * color).cwiseProduct(scene.illuminant);
}

// Mean over the pixel's area, as a sensor does it.
Rgb
pixelColor(const Scene& scene, int u, int v)
{
  const int n = std::max(1, scene.supersampling);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  bool seen = false; // what nobody sees gets no noise: the files stay small
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const Eigen::Vector3d direction =
          scene.camera.ray(u + (i + 0.5) / n - 0.5, v + (j + 0.5) / n - 0.5);
      const Hit hit = cast(scene, Eigen::Vector3d::Zero(), direction);
      seen |= hit.object >= 0;
      sum += shade(scene, direction, hit);
    }
  sum /= n * n;
  if (scene.noise.enabled && seen)
    for (int k = 0; k < 3; ++k)
      sum[k] += scene.noise.color_sigma * hashNormal(scene.seed ^ 0xc0, u, v, k);
  Rgb rgb;
  for (int k = 0; k < 3; ++k)
    rgb[k] = static_cast<unsigned char>(std::clamp(sum[k] + 0.5, 0.0, 255.0));
  return rgb;
}

// A depth step next to the pixel.
bool
onSilhouette(const cv::Mat1f& depth, int u, int v)
{
  const float z = depth(v, u);
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) {
      const int x = u + i, y = v + j;
      if (x < 0 || y < 0 || x >= depth.cols || y >= depth.rows)
        continue;
      const float other = depth(y, x);
      if (!(std::abs(other - z) < 0.04f * std::max(1.0f, z)))
        return true;
    }
  return false;
}

// The depth that the sensor reports at a pixel; NaN where it reports none.
double
measuredDepth(const Scene& scene, const cv::Mat1f& exact, int u, int v)
{
  const Noise& noise = scene.noise;
  const auto shift = [&](int salt) {
    return static_cast<int>(std::floor(
        noise.lateral_sigma * hashNormal(scene.seed ^ 0xd0, u, v, salt) + 0.5));
  };
  const int x = std::clamp(u + shift(0), 0, exact.cols - 1);
  const int y = std::clamp(v + shift(1), 0, exact.rows - 1);
  const double z = exact(y, x);
  if (!(z > 0))
    return nan;
  if (noise.dropout > 0 && onSilhouette(exact, x, y) &&
      hash01(scene.seed ^ 0xe0, u, v) < noise.dropout)
    return nan;
  if (noise.baseline != 0) {
    const Eigen::Vector3d p = (1 - 1e-6) * z * scene.camera.ray(x, y);
    if (blocked(scene, p, Eigen::Vector3d(noise.baseline, 0, 0)))
      return nan;
  }
  // 0.8 of the error is shared by a 3 x 3 neighbourhood, 0.6 is the pixel's own
  double common = 0;
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i)
      common += hashNormal(scene.seed ^ 0xf0, u + i, v + j, 1) / 3.0;
  const double error = 0.8 * common + 0.6 * hashNormal(scene.seed ^ 0xf1, u, v, 2);
  double measured = z + noise.sensor.sigmaZ(z) * error;
  if (noise.disparity_step > 0 && noise.sensor.kind != SensorModel::Kind::constant) {
    // the Kinect's infrared camera: f = 580 px, B = 0.075 m
    const double focal_baseline = noise.sensor.kind == SensorModel::Kind::stereo
                                      ? noise.sensor.focal_baseline
                                      : 580.0 * 0.075;
    const double steps = focal_baseline / measured / noise.disparity_step;
    measured = focal_baseline / (std::floor(steps + 0.5) * noise.disparity_step);
  }
  return measured > 0 ? measured : nan;
}

void
countPixels(const Scene& scene, FrameTruth& truth)
{
  const int width = scene.width, height = scene.height;
  truth.boxes.clear();
  for (const Box& box : scene.boxes) {
    BoxTruth entry;
    entry.box = box;
    for (int v = 0; v < height; ++v)
      for (int u = 0; u < width; ++u) {
        Hit hit;
        if (!cast(box, Eigen::Vector3d::Zero(), scene.camera.ray(u, v), hit))
          continue;
        ++entry.alone_pixels;
        if (u == 0 || v == 0 || u == width - 1 || v == height - 1)
          entry.touches_border = true;
      }
    truth.boxes.push_back(entry);
  }
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      const int object = truth.object(v, u);
      if (object < 0 || object >= static_cast<int>(truth.boxes.size()))
        continue;
      ++truth.boxes[object].visible_pixels;
      ++truth.boxes[object].face_pixels[truth.face(v, u)];
    }
}

} // namespace

int
BoxTruth::facesVisible(std::size_t min_pixels) const
{
  int n = 0;
  for (const std::size_t pixels : face_pixels)
    n += pixels >= min_pixels ? 1 : 0;
  return n;
}

std::array<bool, 6>
BoxTruth::visibleFaces(std::size_t min_pixels) const
{
  std::array<bool, 6> seen{};
  for (int i = 0; i < 6; ++i)
    seen[i] = face_pixels[i] >= min_pixels;
  return seen;
}

Frame
render(const Scene& scene)
{
  Frame frame;
  FrameTruth& truth = frame.truth;
  truth.object.create(scene.height, scene.width);
  truth.face.create(scene.height, scene.width);
  truth.exact_depth.create(scene.height, scene.width);
  for (int v = 0; v < scene.height; ++v)
    for (int u = 0; u < scene.width; ++u) {
      // rays have z = 1, so that the distance along them is the depth
      const Hit hit = cast(scene, Eigen::Vector3d::Zero(), scene.camera.ray(u, v));
      truth.object(v, u) = hit.object;
      truth.face(v, u) = hit.object < 0 ? 255 : static_cast<unsigned char>(hit.face);
      truth.exact_depth(v, u) = hit.object < 0 ? nan : static_cast<float>(hit.distance);
    }
  countPixels(scene, truth);

  frame.cloud.width = static_cast<std::uint32_t>(scene.width);
  frame.cloud.height = static_cast<std::uint32_t>(scene.height);
  frame.cloud.resize(frame.cloud.width, frame.cloud.height);
  frame.cloud.is_dense = true;
  if (scene.pose_known) {
    frame.cloud.sensor_origin_.head<3>() = scene.pose.translation().cast<float>();
    frame.cloud.sensor_orientation_ =
        Eigen::Quaterniond(scene.pose.linear()).cast<float>();
  }
  for (int v = 0; v < scene.height; ++v)
    for (int u = 0; u < scene.width; ++u) {
      auto& point = frame.cloud(u, v);
      const Eigen::Vector3d ray = scene.camera.ray(u, v);
      double z = truth.exact_depth(v, u);
      if (scene.noise.enabled)
        z = measuredDepth(scene, truth.exact_depth, u, v);
      else if (truth.object(v, u) >= 0) // not yet rounded
        z = cast(scene, Eigen::Vector3d::Zero(), ray).distance;
      if (z > 0) {
        point.x = static_cast<float>(z * ray.x());
        point.y = static_cast<float>(z * ray.y());
        point.z = static_cast<float>(z);
      }
      else {
        point.x = point.y = point.z = nan;
        frame.cloud.is_dense = false;
      }
      const Rgb rgb = pixelColor(scene, u, v);
      point.r = rgb[0];
      point.g = rgb[1];
      point.b = rgb[2];
      point.a = 255;
    }
  return frame;
}

} // namespace samples
} // namespace hoist
