#pragma once

#include <hoist/filters/export.h>
#include <hoist/filters/frame_filter_indices.h>

#include <opencv2/core.hpp>

#include <vector>

namespace hoist {

/** \brief Keeps the points in a region of the image: a box, a polygon or a mask; what a
 *  detector's box becomes.
 *
 * One region at a time, the last one set; without a region all pixels are in it. The
 * condition of this filter is "the pixel is in the region"; everything else is as
 * \ref FrameFilterIndices says. A region may reach over the image's border; one wholly
 * outside keeps nothing.
 */
template <typename PointT>
class RegionCrop : public FrameFilterIndices<PointT> {
public:
  using Base = FrameFilterIndices<PointT>;
  using Ptr = pcl::shared_ptr<RegionCrop<PointT>>;
  using ConstPtr = pcl::shared_ptr<const RegionCrop<PointT>>;

  /** \param extract_removed_indices keep the indices of removed points too */
  explicit RegionCrop(bool extract_removed_indices = false)
  : Base(extract_removed_indices)
  {
    filter_name_ = "RegionCrop";
  }

  /** \brief Pixels with x <= u < x + width and y <= v < y + height.
   *  \throws pcl::BadArgumentException if a number is not finite or a size negative */
  void setBox(const cv::Rect2d& box);

  /** \brief Pixels whose centre is in the polygon, see \ref fillPolygon; at least 3
   *  finite corners (u, v) [px].
   *  \throws pcl::BadArgumentException otherwise */
  void setPolygon(const std::vector<cv::Point2f>& polygon);

  /** \brief Pixels where the mask is not 0; it must have the frame's size, else
   * filter() throws pcl::BadArgumentException. The mask is copied. */
  void setMask(const cv::Mat1b& mask);

  /** \brief No region: all pixels. */
  void
  clearRegion()
  {
    shape_ = Shape::all;
  }

  /** \brief The pixels of the region in the last frame: 255, else 0. */
  const cv::Mat1b&
  getRegionImage() const
  {
    return region_;
  }

protected:
  using Base::filter_name_;
  using Base::input_;

  void prepare() override;

  bool
  selects(pcl::index_t index) const override
  {
    return region_.data[index] != 0;
  }

private:
  enum class Shape { all, box, polygon, mask };

  Shape shape_ = Shape::all;
  cv::Rect2d box_;
  std::vector<cv::Point2f> polygon_;
  cv::Mat1b mask_, region_;
};

} // namespace hoist

#ifdef PCL_NO_PRECOMPILE
#include <hoist/filters/impl/region_crop.hpp>
#endif
