#pragma once

#include <hoist/data/estimate_intrinsics.h>

#include <pcl/exceptions.h>
#include <pcl/type_traits.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace hoist {
namespace detail {

template <typename PointT, typename = void>
struct HasPixel : std::false_type {
};

template <typename PointT>
struct HasPixel<
    PointT,
    std::void_t<decltype(std::declval<PointT>().u), decltype(std::declval<PointT>().v)>>
: std::true_type {
};

} // namespace detail

template <typename PointT>
Intrinsics
estimateIntrinsics(const pcl::PointCloud<PointT>& cloud, int max_records)
{
  const bool organized = cloud.height > 1;
  if (!organized && !detail::HasPixel<PointT>::value)
    PCL_THROW_EXCEPTION(
        pcl::UnorganizedPointCloudException,
        "intrinsics follow from an organized cloud or from fields u and "
        "v; this cloud has neither");
  // A step that shares no factor with the width would be ideal; an odd one that is no
  // divisor of it runs over all columns as well.
  const std::size_t most = static_cast<std::size_t>(std::max(8, max_records));
  std::size_t step = std::max<std::size_t>(1, (cloud.size() + most - 1) / most);
  while (step > 1 && organized && cloud.width % step == 0)
    ++step;
  const auto rows = static_cast<Eigen::Index>(cloud.size() / step + 1);
  Eigen::MatrixX2d rays(rows, 2), pixels(rows, 2);
  Eigen::Index n = 0;
  for (std::size_t i = step / 2; i < cloud.size(); i += step) {
    const PointT& p = cloud[i];
    if (!(p.z > 0) || !std::isfinite(p.x + p.y + p.z))
      continue;
    double u = 0, v = 0;
    if (organized) {
      const std::size_t column = i % cloud.width, row = i / cloud.width;
      u = static_cast<double>(column);
      v = static_cast<double>(row);
    }
    else if constexpr (detail::HasPixel<PointT>::value) {
      u = p.u;
      v = p.v;
    }
    rays.row(n) << double(p.x) / p.z, double(p.y) / p.z;
    pixels.row(n) << u, v;
    ++n;
  }
  return estimateIntrinsics(rays.topRows(n), pixels.topRows(n));
}

} // namespace hoist

#define PCL_INSTANTIATE_HoistEstimateIntrinsics(T)                                     \
  template HOIST_DATA_EXPORT hoist::Intrinsics hoist::estimateIntrinsics<T>(           \
      const pcl::PointCloud<T>&, int);
