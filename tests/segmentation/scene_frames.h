#pragma once

// Rendered scenes as the input of segmenters, in any point type.

#include <hoist/data/cuboid.h>

#include <samples/generate.h>
#include <samples/render.h>

#include <pcl/point_cloud.h>
#include <pcl/type_traits.h>

namespace hoist {
namespace test {

inline Cuboid
toCuboid(const samples::Box& box)
{
  Cuboid cuboid;
  cuboid.center = box.center;
  cuboid.axes = box.axes;
  cuboid.size = box.size;
  return cuboid;
}

/** \brief The same frame in another point type; grey becomes intensity. */
template <typename PointT>
typename pcl::PointCloud<PointT>::Ptr
convert(const pcl::PointCloud<pcl::PointXYZRGB>& in)
{
  auto out = pcl::make_shared<pcl::PointCloud<PointT>>(in.width, in.height);
  out->is_dense = in.is_dense;
  for (std::size_t i = 0; i < in.size(); ++i) {
    PointT& p = (*out)[i];
    p.x = in[i].x;
    p.y = in[i].y;
    p.z = in[i].z;
    if constexpr (pcl::traits::has_color<PointT>::value) {
      p.r = in[i].r;
      p.g = in[i].g;
      p.b = in[i].b;
    }
    else if constexpr (pcl::traits::has_intensity<PointT>::value)
      p.intensity = 0.299F * in[i].r + 0.587F * in[i].g + 0.114F * in[i].b;
  }
  return out;
}

/** \brief A box on the ground before the camera, without noise. Seed 6 is one that the
 *  paper mode finds. */
inline samples::Scene
boxOnGround(std::uint64_t seed = 6)
{
  samples::RandomBoxOptions options;
  options.on_ground = true;
  return samples::randomBoxScene(seed, options);
}

} // namespace test
} // namespace hoist
