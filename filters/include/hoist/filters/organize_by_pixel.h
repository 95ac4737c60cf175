#pragma once

#include <hoist/filters/export.h>
#include <hoist/filters/pcl_bases.h>

#include <pcl/filters/filter.h>

#include <cstddef>

namespace hoist {

/** \brief Puts records that know their pixel, (x, y, z, u, v) with or without colour,
 *  onto their image: the result is an organized cloud (paper 4.1).
 *
 * Where several records share a pixel the one nearest to the camera (smallest z) stays;
 * of equal ones the first. A pixel without a measured record (z > 0, finite) is NaN,
 * but takes the colour of its first record if it has one: a PTS file lists the whole
 * image, and the retrieved 2D image is the cloud's colour. Pixels without any record
 * are black. Every point of the output knows its own pixel.
 *
 * Only the given indices are used. Removed indices are the records that did not become
 * a point of the output (farther ones, unmeasured ones, those outside the size).
 * Without input the output is cleared and PCL_ERROR tells; indices outside the cloud
 * throw pcl::BadArgumentException.
 *
 * For point types with fields u and v: PointXYZRGBUV, PointXYZUV, or a user's own.
 */
template <typename PointT>
class OrganizeByPixel : public pcl::Filter<PointT> {
public:
  using Base = pcl::Filter<PointT>;
  using PointCloud = pcl::PointCloud<PointT>;
  using Ptr = pcl::shared_ptr<OrganizeByPixel<PointT>>;
  using ConstPtr = pcl::shared_ptr<const OrganizeByPixel<PointT>>;

  /** \param extract_removed_indices keep the numbers of the dropped records */
  explicit OrganizeByPixel(bool extract_removed_indices = false)
  : Base(extract_removed_indices)
  {
    filter_name_ = "OrganizeByPixel";
  }

  /** \brief The organized cloud; cleared first unless it is the input. */
  void filter(PointCloud& output);

  /** \brief Size of the image [px]; 0, 0 (default): just large enough for all records.
   *
   * Records outside are dropped and counted.
   * \throws pcl::BadArgumentException if only one of them is 0 */
  void setSize(std::size_t width, std::size_t height);

  std::size_t
  getWidth() const
  {
    return width_;
  }

  std::size_t
  getHeight() const
  {
    return height_;
  }

  /** \brief Largest image that filter() makes, > 0; default 2^26 pixels.
   *
   * One broken record must not cost the memory of the machine: a larger image throws
   * pcl::BadArgumentException. */
  void
  setMaxPixels(std::size_t pixels)
  {
    max_pixels_ = pixels;
  }

  std::size_t
  getMaxPixels() const
  {
    return max_pixels_;
  }

  /** \brief Records of the last call that lay outside the given size. */
  std::size_t
  getOutsideCount() const
  {
    return outside_;
  }

protected:
  using Base::extract_removed_indices_;
  using Base::filter_name_;
  using Base::indices_;
  using Base::input_;
  using Base::removed_indices_;

  void applyFilter(PointCloud& output) override;

private:
  std::size_t width_ = 0, height_ = 0;
  std::size_t max_pixels_ = std::size_t(1) << 26;
  std::size_t outside_ = 0;
};

} // namespace hoist

#ifdef PCL_NO_PRECOMPILE
#include <hoist/filters/impl/organize_by_pixel.hpp>
#endif
