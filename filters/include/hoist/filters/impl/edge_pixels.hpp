#pragma once

#include <hoist/filters/edge_pixels.h>
#include <hoist/filters/impl/frame_filter_indices.hpp>

#include <stdexcept>

namespace hoist {

template <typename PointT>
void
EdgePixels<PointT>::setKinds(int kinds)
{
  if (kinds <= 0 || (kinds & ~EDGE_ALL) != 0)
    PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                        "[hoist::EdgePixels::setKinds] " << kinds
                                                         << " is no set of EdgeKind");
  parameters_.kinds = kinds;
}

template <typename PointT>
void
EdgePixels<PointT>::setCannyThresholds(double low, double high)
{
  if (!(low > 0 && low <= high))
    PCL_THROW_EXCEPTION(
        pcl::BadArgumentException,
        "[hoist::EdgePixels::setCannyThresholds] needs 0 < low <= high, "
        "not "
            << low << ", " << high);
  parameters_.canny.auto_threshold = false;
  parameters_.canny.low = low;
  parameters_.canny.high = high;
}

template <typename PointT>
void
EdgePixels<PointT>::setThresholdScale(double scale)
{
  if (!(scale > 0))
    PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                        "[hoist::EdgePixels::setThresholdScale] must be > 0, not "
                            << scale);
  parameters_.canny.threshold_scale = scale;
}

template <typename PointT>
void
EdgePixels<PointT>::setNearSideRadius(int radius)
{
  if (radius < 0 || radius > 16)
    PCL_THROW_EXCEPTION(
        pcl::BadArgumentException,
        "[hoist::EdgePixels::setNearSideRadius] must be in 0 ... 16, not " << radius);
  parameters_.near_side_radius = radius;
}

template <typename PointT>
void
EdgePixels<PointT>::prepare()
{
  const FrameImages* images = images_.get();
  if (images == nullptr) {
    toFrameImages(*input_, own_images_);
    images = &own_images_;
  }
  else if (images->width() != static_cast<int>(input_->width) ||
           images->height() != static_cast<int>(input_->height))
    PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                        "[hoist::EdgePixels::filter] frame images of "
                            << images->width() << " x " << images->height()
                            << " for a cloud of " << input_->width << " x "
                            << input_->height);
  try {
    detector_.detect(*images, parameters_, labels_);
  }
  catch (const std::invalid_argument& error) {
    PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                        "[hoist::EdgePixels::filter] " << error.what());
  }
}

} // namespace hoist

#define PCL_INSTANTIATE_HoistEdgePixels(T)                                             \
  template class HOIST_FILTERS_EXPORT hoist::EdgePixels<T>;
