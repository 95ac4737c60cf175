#pragma once

#include <hoist/filters/export.h>
#include <hoist/filters/pcl_bases.h>

#include <pcl/filters/filter_indices.h>

#include <string>

namespace hoist {

/** \brief What the pixel selecting filters of hoist have in common.
 *
 * Behaves as every pcl::FilterIndices (negative, keep_organized, user filter value,
 * removed indices, user indices), and is stricter where PCL is silent:
 *  - without input the outputs are cleared, and PCL_ERROR tells;
 *  - user indices outside the cloud throw pcl::BadArgumentException;
 *  - a cloud that is not organized (height > 1) throws
 *    pcl::UnorganizedPointCloudException; an empty one gives an empty result;
 *  - keep_organized does not change setExtractRemovedIndices.
 * Outputs index the input cloud, in the order of the given indices. Points that are not
 * finite are always removed, also under negative. Neighbours come from the whole cloud,
 * not only from the given indices.
 *
 * A filter implements prepare() and selects().
 */
template <typename PointT>
class FrameFilterIndices : public pcl::FilterIndices<PointT> {
public:
  using Base = pcl::FilterIndices<PointT>;
  using PointCloud = pcl::PointCloud<PointT>;
  using Ptr = pcl::shared_ptr<FrameFilterIndices<PointT>>;
  using ConstPtr = pcl::shared_ptr<const FrameFilterIndices<PointT>>;

  /** \param extract_removed_indices keep the indices of removed points too */
  explicit FrameFilterIndices(bool extract_removed_indices = false)
  : Base(extract_removed_indices)
  {
  }

  /** \brief Indices of the kept points; cleared first. */
  void filter(pcl::Indices& indices);

  /** \brief The kept points; cleared first unless it is the input. */
  void filter(PointCloud& output);

protected:
  using Base::extract_removed_indices_;
  using Base::fake_indices_;
  using Base::filter_name_;
  using Base::indices_;
  using Base::input_;
  using Base::keep_organized_;
  using Base::negative_;
  using Base::removed_indices_;

  /** \brief Gets ready to answer selects() for the points of input_. */
  virtual void prepare() = 0;

  /** \brief Does the pixel fulfil the filter's condition? */
  virtual bool selects(pcl::index_t index) const = 0;

  /** \brief Called for each kept index, in order. */
  virtual void
  kept(pcl::index_t /*index*/)
  {
  }

  /** \brief Forgets the results of the last call. */
  virtual void
  clear()
  {
  }

  void applyFilter(pcl::Indices& indices) override;
  void applyFilter(PointCloud& output) override;

private:
  // Forgets the last call; false if there is no input.
  bool start();
  // Throws on bad input.
  void check() const;
};

} // namespace hoist

#ifdef PCL_NO_PRECOMPILE
#include <hoist/filters/impl/frame_filter_indices.hpp>
#endif
