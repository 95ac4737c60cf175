#pragma once

#include <hoist/filters/impl/frame_filter_indices.hpp>
#include <hoist/filters/polygon_mask.h>
#include <hoist/filters/region_crop.h>

#include <cmath>
#include <stdexcept>

namespace hoist {

template <typename PointT>
void
RegionCrop<PointT>::setBox(const cv::Rect2d& box)
{
  if (!std::isfinite(box.x + box.y + box.width + box.height) || box.width < 0 ||
      box.height < 0)
    PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                        "[hoist::RegionCrop::setBox] not a box: "
                            << box.x << ", " << box.y << ", " << box.width << " x "
                            << box.height);
  shape_ = Shape::box;
  box_ = box;
}

template <typename PointT>
void
RegionCrop<PointT>::setPolygon(const std::vector<cv::Point2f>& polygon)
{
  try {
    cv::Mat1b nothing;
    fillPolygon(polygon, nothing);
  }
  catch (const std::invalid_argument& error) {
    PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                        "[hoist::RegionCrop::setPolygon] " << error.what());
  }
  shape_ = Shape::polygon;
  polygon_ = polygon;
}

template <typename PointT>
void
RegionCrop<PointT>::setMask(const cv::Mat1b& mask)
{
  shape_ = Shape::mask;
  mask_ = mask.clone();
}

template <typename PointT>
void
RegionCrop<PointT>::prepare()
{
  region_.create(static_cast<int>(input_->height), static_cast<int>(input_->width));
  switch (shape_) {
  case Shape::all:
    region_.setTo(255);
    break;
  case Shape::box:
    for (int v = 0; v < region_.rows; ++v)
      for (int u = 0; u < region_.cols; ++u)
        region_(v, u) = u >= box_.x && u < box_.x + box_.width && v >= box_.y &&
                                v < box_.y + box_.height
                            ? 255
                            : 0;
    break;
  case Shape::polygon:
    fillPolygon(polygon_, region_);
    break;
  case Shape::mask:
    if (mask_.size() != region_.size())
      PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                          "[hoist::RegionCrop::filter] a mask of "
                              << mask_.cols << " x " << mask_.rows << " for a cloud of "
                              << region_.cols << " x " << region_.rows);
    for (int v = 0; v < region_.rows; ++v)
      for (int u = 0; u < region_.cols; ++u)
        region_(v, u) = mask_(v, u) != 0 ? 255 : 0;
    break;
  }
}

} // namespace hoist

#define PCL_INSTANTIATE_HoistRegionCrop(T)                                             \
  template class HOIST_FILTERS_EXPORT hoist::RegionCrop<T>;
