#pragma once

#include <hoist/data/estimate_intrinsics.h>
#include <hoist/data/frame_images.h>

#include <pcl/exceptions.h>
#include <pcl/point_types.h>
#include <pcl/type_traits.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace hoist {
namespace detail {

inline unsigned char
luma(int r, int g, int b)
{
  return static_cast<unsigned char>((299 * r + 587 * g + 114 * b + 500) / 1000);
}

} // namespace detail

template <typename PointT>
void
toFrameImages(const pcl::PointCloud<PointT>& cloud, FrameImages& images)
{
  if (cloud.height <= 1 ||
      cloud.size() != static_cast<std::size_t>(cloud.width) * cloud.height)
    PCL_THROW_EXCEPTION(pcl::UnorganizedPointCloudException,
                        "a frame needs an organized cloud (height > 1), not "
                            << cloud.width << " x " << cloud.height);
  const int width = static_cast<int>(cloud.width);
  const int height = static_cast<int>(cloud.height);
  constexpr bool color = pcl::traits::has_color<PointT>::value;
  constexpr bool intensity = pcl::traits::has_intensity<PointT>::value;
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();

  images.points.create(height, width);
  images.inverse_depth.create(height, width);
  if (color || intensity) {
    images.bgr.create(height, width);
    images.gray.create(height, width);
  }
  else {
    images.bgr.release();
    images.gray.release();
  }

  for (int v = 0; v < height; ++v) {
    const PointT* in = &cloud[static_cast<std::size_t>(v) * width];
    cv::Vec3f* point = images.points[v];
    float* inverse = images.inverse_depth[v];
    for (int u = 0; u < width; ++u) {
      const PointT& p = in[u];
      // x and y are tested too: a NaN anywhere makes the sum NaN
      const bool measured = p.z > 0 && std::isfinite(p.x + p.y + p.z);
      point[u] = measured ? cv::Vec3f(p.x, p.y, p.z) : cv::Vec3f(nan, nan, nan);
      inverse[u] = measured ? 1.0f / p.z : 0.0f;
    }
    if constexpr (color) {
      cv::Vec3b* bgr = images.bgr[v];
      unsigned char* gray = images.gray[v];
      for (int u = 0; u < width; ++u) {
        bgr[u] = {in[u].b, in[u].g, in[u].r};
        gray[u] = detail::luma(in[u].r, in[u].g, in[u].b);
      }
    }
    else if constexpr (intensity) {
      cv::Vec3b* bgr = images.bgr[v];
      unsigned char* gray = images.gray[v];
      for (int u = 0; u < width; ++u) {
        gray[u] = cv::saturate_cast<unsigned char>(in[u].intensity);
        bgr[u] = {gray[u], gray[u], gray[u]};
      }
    }
  }
  images.intrinsics = estimateIntrinsics(images.points);
}

} // namespace hoist

#define PCL_INSTANTIATE_HoistToFrameImages(T)                                          \
  template HOIST_DATA_EXPORT void hoist::toFrameImages<T>(const pcl::PointCloud<T>&,   \
                                                          hoist::FrameImages&);
