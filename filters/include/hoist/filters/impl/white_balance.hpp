#pragma once

#include <hoist/filters/white_balance.h>

#include <pcl/console/print.h>
#include <pcl/exceptions.h>
#include <pcl/impl/pcl_base.hpp>

#include <stdexcept>

namespace hoist {

template <typename PointT>
void
WhiteBalance<PointT>::setPercentile(double percentile)
{
  if (!(percentile > 0 && percentile <= 100))
    PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                        "[hoist::WhiteBalance::setPercentile] must be in (0, 100], not "
                            << percentile);
  parameters_.percentile = percentile;
}

template <typename PointT>
void
WhiteBalance<PointT>::filter(PointCloud& output)
{
  gains_ = ColorGains();
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
WhiteBalance<PointT>::applyFilter(PointCloud& output)
{
  removed_indices_->clear();
  ColorHistogram histogram(parameters_);
  for (const auto index : *indices_) {
    if (index < 0 || static_cast<std::size_t>(index) >= input_->size())
      PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                          "[hoist::WhiteBalance::filter] index "
                              << index << " is outside the cloud of " << input_->size()
                              << " points");
    const PointT& p = (*input_)[index];
    histogram.add(p.r, p.g, p.b);
  }
  try {
    gains_ = estimateGains(histogram, parameters_);
  }
  catch (const std::invalid_argument& error) {
    PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                        "[hoist::WhiteBalance::filter] " << error.what());
  }
  const auto tables = gainTables(gains_);
  output = *input_;
  for (auto& p : output) {
    p.r = tables[0][p.r];
    p.g = tables[1][p.g];
    p.b = tables[2][p.b];
  }
}

} // namespace hoist

#define PCL_INSTANTIATE_HoistWhiteBalance(T)                                           \
  template class HOIST_FILTERS_EXPORT hoist::WhiteBalance<T>;
