#include <hoist/simulation/render.h>

#include <cmath>
#include <limits>

namespace hoist {
namespace simulation {
namespace {

// Brown and Conrady's model, as OpenCV has it.
Eigen::Vector2d
distort(const std::array<double, 5>& d, const Eigen::Vector2d& p)
{
  const double x = p.x(), y = p.y(), r2 = p.squaredNorm();
  const double radial = 1 + r2 * (d[0] + r2 * (d[1] + r2 * d[4]));
  return {x * radial + 2 * d[2] * x * y + d[3] * (r2 + 2 * x * x),
          y * radial + d[2] * (r2 + 2 * y * y) + 2 * d[3] * x * y};
}

} // namespace

Eigen::Vector3d
Lens::ray(double u, double v) const
{
  Eigen::Vector3d ray = camera_.ray(u, v);
  if (!distorted_)
    return ray;
  const Eigen::Vector2d target = ray.head<2>();
  Eigen::Vector2d p = target;
  for (int i = 0; i < 20; ++i) // a fixed point, as OpenCV's undistortPoints
    p += target - distort(distortion_, p);
  return {p.x(), p.y(), 1.0};
}

Eigen::Vector2d
Lens::project(const Eigen::Vector3d& p) const
{
  const Eigen::Vector2d d = distort(distortion_, p.head<2>() / p.z());
  return {camera_.fx * d.x() + camera_.cx, camera_.fy * d.y() + camera_.cy};
}

PixelHits
castPixels(const RayCaster& caster,
           const Lens& lens,
           const cv::Size& size,
           const Eigen::Isometry3d& pose)
{
  PixelHits seen;
  seen.size = size;
  seen.hits.resize(static_cast<std::size_t>(size.area()));
  const Eigen::Vector3d origin = pose.translation();
  for (int v = 0; v < size.height; ++v)
    for (int u = 0; u < size.width; u += 4) {
      const int count = std::min(4, size.width - u);
      Eigen::Vector3d directions[4];
      for (int i = 0; i < 4; ++i)
        directions[i] = pose.linear() * lens.ray(u + std::min(i, count - 1), v);
      Hit hits[4];
      caster.cast4(origin, directions, hits);
      std::copy_n(
          hits, count, &seen.hits[static_cast<std::size_t>(v) * size.width + u]);
    }
  return seen;
}

Layer
layerOf(const PixelHits& seen, const Lens& lens, const Eigen::Isometry3d& pose)
{
  Layer layer;
  layer.thing.create(seen.size);
  layer.face.create(seen.size);
  layer.depth.create(seen.size);
  layer.cosine.create(seen.size);
  layer.normal.create(seen.size);
  const Eigen::Matrix3d to_camera = pose.linear().transpose();
  for (int v = 0; v < seen.size.height; ++v)
    for (int u = 0; u < seen.size.width; ++u) {
      const Hit& hit = seen(u, v);
      layer.thing(v, u) = hit.thing;
      layer.face(v, u) = hit.face;
      const Eigen::Vector3d normal = to_camera * hit.normal;
      layer.normal(v, u) = {static_cast<float>(normal.x()),
                            static_cast<float>(normal.y()),
                            static_cast<float>(normal.z())};
      // rays have z = 1, so that the distance along them is the depth
      layer.depth(v, u) =
          hit.thing < 0 ? std::numeric_limits<double>::quiet_NaN() : hit.distance;
      const Eigen::Vector3d ray = lens.ray(u, v);
      layer.cosine(v, u) =
          static_cast<float>(hit.thing < 0 ? 0 : -normal.dot(ray) / ray.norm());
    }
  return layer;
}

} // namespace simulation
} // namespace hoist
