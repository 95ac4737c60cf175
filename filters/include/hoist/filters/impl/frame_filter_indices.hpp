#pragma once

#include <hoist/filters/frame_filter_indices.h>

#include <pcl/common/point_tests.h>
#include <pcl/console/print.h>
#include <pcl/exceptions.h>
#include <pcl/filters/impl/filter_indices.hpp>
#include <pcl/impl/pcl_base.hpp>

namespace hoist {

template <typename PointT>
bool
FrameFilterIndices<PointT>::start()
{
  removed_indices_->clear();
  clear();
  if (!input_)
    PCL_ERROR("[hoist::%s::filter] No input cloud.\n", this->getClassName().c_str());
  return input_ != nullptr;
}

template <typename PointT>
void
FrameFilterIndices<PointT>::filter(pcl::Indices& indices)
{
  pcl::Indices result; // the caller may hand in the very vector that setIndices() got
  if (start()) {
    try {
      Base::filter(result);
    }
    catch (...) {
      indices.clear();
      throw;
    }
  }
  indices.swap(result);
}

template <typename PointT>
void
FrameFilterIndices<PointT>::filter(PointCloud& output)
{
  if (&output != input_.get())
    output = PointCloud();
  if (start())
    Base::filter(output);
}

template <typename PointT>
void
FrameFilterIndices<PointT>::check() const
{
  for (const auto index : *indices_)
    if (index < 0 || static_cast<std::size_t>(index) >= input_->size())
      PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                          "[hoist::" << this->getClassName() << "::filter] index "
                                     << index << " is outside the cloud of "
                                     << input_->size() << " points");
  if (!input_->empty() &&
      (input_->height <= 1 ||
       input_->size() != static_cast<std::size_t>(input_->width) * input_->height))
    PCL_THROW_EXCEPTION(pcl::UnorganizedPointCloudException,
                        "[hoist::" << this->getClassName()
                                   << "::filter] needs an organized cloud, not "
                                   << input_->width << " x " << input_->height);
}

template <typename PointT>
void
FrameFilterIndices<PointT>::applyFilter(pcl::Indices& indices)
{
  indices.clear();
  removed_indices_->clear();
  clear();
  check();
  if (input_->empty())
    return;
  prepare();
  for (const auto index : *indices_)
    if (pcl::isXYZFinite((*input_)[index]) && selects(index) != negative_) {
      indices.push_back(index);
      kept(index);
    }
    else if (extract_removed_indices_)
      removed_indices_->push_back(index);
}

template <typename PointT>
void
FrameFilterIndices<PointT>::applyFilter(PointCloud& output)
{
  // The base needs the removed indices to keep the cloud organized; left to itself it
  // switches them on for good, with a warning.
  struct Restore {
    bool& flag;
    bool value;
    ~Restore() { flag = value; }
  } restore{extract_removed_indices_, extract_removed_indices_};
  extract_removed_indices_ |= keep_organized_;
  Base::applyFilter(output);
  if (!keep_organized_)
    output.is_dense = true; // the base has copied the input's; all kept are finite
  if (!restore.value)
    removed_indices_->clear();
}

} // namespace hoist

#define PCL_INSTANTIATE_HoistFrameFilterIndices(T)                                     \
  template class HOIST_FILTERS_EXPORT hoist::FrameFilterIndices<T>;
/// For sources of hoist_filters that derive from it: the one instantiation is
/// elsewhere.
#define PCL_INSTANTIATE_HoistExternFrameFilterIndices(T)                               \
  extern template class HOIST_FILTERS_EXPORT hoist::FrameFilterIndices<T>;
