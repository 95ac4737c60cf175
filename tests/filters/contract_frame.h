#pragma once

#include <hoist/data/point_types.h>

#include <pcl/for_each_type.h>
#include <pcl/point_cloud.h>
#include <pcl/type_traits.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace hoist {
namespace test {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

// A box before a wall, both textured, with unmeasured pixels: 64 x 48, f = 50 px.
template <typename PointT>
typename pcl::PointCloud<PointT>::Ptr
contractFrame()
{
  constexpr int width = 64, height = 48;
  auto cloud = pcl::make_shared<pcl::PointCloud<PointT>>();
  cloud->resize(width * height);
  cloud->width = width;
  cloud->height = height;
  cloud->is_dense = false;
  cloud->header.frame_id = "camera";
  cloud->sensor_origin_ << 1, 2, 3, 1;
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      PointT& p = (*cloud)[v * width + u];
      const bool box = u >= 20 && u < 44 && v >= 12 && v < 36;
      const bool hole = (u * 7 + v * 13) % 97 == 0;
      p.z = hole ? not_a_number : (box ? 0.8F + 0.004F * std::abs(u - 32) : 1.5F);
      p.x = (u - 31.5F) / 50 * p.z;
      p.y = (v - 23.5F) / 50 * p.z;
      const auto value = static_cast<std::uint8_t>(box ? 200 - u % 3 : 60 + v % 2);
      if constexpr (pcl::traits::has_color<PointT>::value) {
        p.r = value;
        p.g = static_cast<std::uint8_t>(value / 2 + 20);
        p.b = static_cast<std::uint8_t>(value / 3 + 20);
      }
      if constexpr (pcl::traits::has_intensity<PointT>::value)
        p.intensity = value;
      if constexpr (pcl::traits::has_field<PointT, pcl::fields::u>::value) {
        p.u = static_cast<std::uint32_t>(u);
        p.v = static_cast<std::uint32_t>(v);
      }
    }
  return cloud;
}

// pcl::for_each_type calls operator() with the field as its template argument.
template <typename PointT>
struct CompareFields {
  const PointT& a;
  const PointT& b;
  bool& same;

  template <typename Field>
  void
  operator()()
  {
    constexpr auto offset = pcl::traits::offset<PointT, Field>::value;
    constexpr auto size = sizeof(typename pcl::traits::datatype<PointT, Field>::type);
    same = same && std::memcmp(reinterpret_cast<const char*>(&a) + offset,
                               reinterpret_cast<const char*>(&b) + offset,
                               size) == 0;
  }
};

// Same bytes in every field, because NaN equals nothing by value.
template <typename PointT>
::testing::AssertionResult
sameClouds(const pcl::PointCloud<PointT>& a, const pcl::PointCloud<PointT>& b)
{
  if (a.width != b.width || a.height != b.height || a.size() != b.size())
    return ::testing::AssertionFailure() << a.width << " x " << a.height << " against "
                                         << b.width << " x " << b.height;
  if (a.is_dense != b.is_dense)
    return ::testing::AssertionFailure() << "is_dense differs";
  for (std::size_t i = 0; i < a.size(); ++i) {
    bool same = true;
    pcl::for_each_type<typename pcl::traits::fieldList<PointT>::type>(
        CompareFields<PointT>{a[i], b[i], same});
    if (!same)
      return ::testing::AssertionFailure() << "point " << i << " differs";
  }
  return ::testing::AssertionSuccess();
}

} // namespace test
} // namespace hoist
