#pragma once

#include <hoist/segmentation/impl/frame_input.hpp>
#include <hoist/segmentation/line_segment_extraction.h>

#include <pcl/exceptions.h>
#include <pcl/impl/pcl_base.hpp>

#include <cmath>

namespace hoist {

template <typename PointT>
void
LineSegmentExtraction<PointT>::setHough(const HoughParameters& parameters)
{
  if (!parameters.valid())
    PCL_THROW_EXCEPTION(
        pcl::BadArgumentException,
        "hoist::LineSegmentExtraction: a Hough parameter is out of range");
  parameters_.hough = parameters;
}

template <typename PointT>
void
LineSegmentExtraction<PointT>::setEndSearchRadius(int radius)
{
  if (radius < 0)
    PCL_THROW_EXCEPTION(
        pcl::BadArgumentException,
        "hoist::LineSegmentExtraction: the search radius must be >= 0 pixels");
  parameters_.end_search_radius = radius;
}

template <typename PointT>
void
LineSegmentExtraction<PointT>::setStripWidth(int width)
{
  if (width < 2)
    PCL_THROW_EXCEPTION(
        pcl::BadArgumentException,
        "hoist::LineSegmentExtraction: the strip must be >= 2 pixels wide");
  parameters_.strip_width = width;
}

template <typename PointT>
void
LineSegmentExtraction<PointT>::setMinLength(double length)
{
  if (!(length >= 0) || !std::isfinite(length))
    PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                        "hoist::LineSegmentExtraction: the smallest length must "
                        "be finite and >= 0 metres");
  parameters_.min_length = length;
}

template <typename PointT>
bool
LineSegmentExtraction<PointT>::segment(std::vector<LineSegment>& segments)
{
  constexpr const char* name = "LineSegmentExtraction";
  segments.clear();
  diagnostics_.clear();
  if (!input_) {
    PCL_ERROR("[hoist::%s::segment] No input cloud.\n", name);
    return false;
  }
  if (!use_indices_ || !indices_) {
    PCL_ERROR("[hoist::%s::segment] No edge pixels: setIndices() comes first.\n", name);
    return false;
  }
  if (!initCompute()) {
    deinitCompute();
    return false;
  }
  const FrameImages::ConstPtr images =
      detail::frameImagesOf(name, *input_, images_, own_images_);
  const bool usable =
      images && detail::maskOf(name, *indices_, images->points.size(), mask_);
  if (usable) {
    diagnostics_.counts.add("edge pixels",
                            static_cast<std::size_t>(cv::countNonZero(mask_)));
    extractLineSegments(*images, mask_, parameters_, segments, diagnostics_);
  }
  deinitCompute();
  return usable;
}

} // namespace hoist

#define PCL_INSTANTIATE_HoistLineSegmentExtraction(T)                                  \
  template class HOIST_SEGMENTATION_EXPORT hoist::LineSegmentExtraction<T>;
