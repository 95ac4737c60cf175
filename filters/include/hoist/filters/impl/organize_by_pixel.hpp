#pragma once

#include <hoist/filters/organize_by_pixel.h>

#include <pcl/console/print.h>
#include <pcl/exceptions.h>
#include <pcl/impl/pcl_base.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace hoist {

template <typename PointT>
void
OrganizeByPixel<PointT>::setSize(std::size_t width, std::size_t height)
{
  if ((width == 0) != (height == 0))
    PCL_THROW_EXCEPTION(
        pcl::BadArgumentException,
        "[hoist::OrganizeByPixel::setSize] not a size: " << width << " x " << height);
  width_ = width;
  height_ = height;
}

template <typename PointT>
void
OrganizeByPixel<PointT>::filter(PointCloud& output)
{
  removed_indices_->clear();
  outside_ = 0;
  if (&output != input_.get())
    output = PointCloud();
  if (!input_) {
    PCL_ERROR("[hoist::%s::filter] No input cloud.\n", this->getClassName().c_str());
    return;
  }
  Base::filter(output);
}

template <typename PointT>
void
OrganizeByPixel<PointT>::applyFilter(PointCloud& output)
{
  constexpr auto nan = std::numeric_limits<float>::quiet_NaN();
  removed_indices_->clear();
  outside_ = 0;
  std::size_t width = width_, height = height_;
  for (const auto index : *indices_) {
    if (index < 0 || static_cast<std::size_t>(index) >= input_->size())
      PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                          "[hoist::OrganizeByPixel::filter] index "
                              << index << " is outside the cloud of " << input_->size()
                              << " records");
    if (width_ == 0) {
      const PointT& record = (*input_)[index];
      width = std::max(width, static_cast<std::size_t>(record.u) + 1);
      height = std::max(height, static_cast<std::size_t>(record.v) + 1);
    }
  }
  // division: the product may overflow
  if (width > 0 && height > max_pixels_ / width)
    PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                        "[hoist::OrganizeByPixel::filter] an image of "
                            << width << " x " << height << " exceeds the limit of "
                            << max_pixels_ << " pixels");

  const auto measured = [](const PointT& p) {
    return p.z > 0 && std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  };
  constexpr pcl::index_t none = -1;
  std::vector<pcl::index_t> record_of_pixel(width * height, none);
  for (const auto index : *indices_) {
    const PointT& record = (*input_)[index];
    if (record.u >= width || record.v >= height) {
      ++outside_;
      continue;
    }
    auto& best = record_of_pixel[record.v * width + record.u];
    const bool better =
        best == none || (measured(record) &&
                         (!measured((*input_)[best]) || record.z < (*input_)[best].z));
    if (better)
      best = index;
  }

  output.clear();
  output.resize(width * height);
  output.width = static_cast<std::uint32_t>(width);
  output.height = static_cast<std::uint32_t>(height);
  output.is_dense = true;
  for (std::size_t i = 0; i < record_of_pixel.size(); ++i) {
    PointT& p = output[i];
    if (record_of_pixel[i] != none)
      p = (*input_)[record_of_pixel[i]];
    if (record_of_pixel[i] == none || !measured(p)) {
      p.x = p.y = p.z = nan;
      output.is_dense = false;
    }
    p.u = static_cast<std::uint32_t>(i % width);
    p.v = static_cast<std::uint32_t>(i / width);
  }
  if (extract_removed_indices_)
    for (const auto index : *indices_) {
      const PointT& record = (*input_)[index];
      if (record.u >= width || record.v >= height || !measured(record) ||
          record_of_pixel[record.v * width + record.u] != index)
        removed_indices_->push_back(index);
    }
}

} // namespace hoist

#define PCL_INSTANTIATE_HoistOrganizeByPixel(T)                                        \
  template class HOIST_FILTERS_EXPORT hoist::OrganizeByPixel<T>;
