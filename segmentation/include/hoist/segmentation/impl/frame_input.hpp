#pragma once

#include <hoist/data/frame_images.h>
#include <hoist/data/impl/frame_images.hpp>

#include <pcl/console/print.h>
#include <pcl/point_cloud.h>
#include <pcl/types.h>

namespace hoist {
namespace detail {

/** \brief The images of a stage's input: the shared ones, or the cloud converted.
 *
 * \param name the class, for messages
 * \param shared may be null
 * \param own buffers that are kept from call to call
 * \return null, with a PCL_ERROR, if the cloud is not organized or the shared images
 *         have another size
 */
template <typename PointT>
FrameImages::ConstPtr
frameImagesOf(const char* name,
              const pcl::PointCloud<PointT>& cloud,
              const FrameImages::ConstPtr& shared,
              FrameImages::Ptr& own)
{
  if (cloud.height <= 1 ||
      cloud.size() != static_cast<std::size_t>(cloud.width) * cloud.height) {
    PCL_ERROR("[hoist::%s::segment] The input is not organized: %u x %u, %zu points.\n",
              name,
              cloud.width,
              cloud.height,
              cloud.size());
    return nullptr;
  }
  if (shared) {
    if (shared->width() == static_cast<int>(cloud.width) &&
        shared->height() == static_cast<int>(cloud.height))
      return shared;
    PCL_ERROR("[hoist::%s::segment] The images are %d x %d, the cloud is %u x %u.\n",
              name,
              shared->width(),
              shared->height(),
              cloud.width,
              cloud.height);
    return nullptr;
  }
  if (!own)
    own = pcl::make_shared<FrameImages>();
  toFrameImages(cloud, *own);
  return own;
}

/** \brief A mask of the image, 255 at the indices.
 *  \return false, with a PCL_ERROR, if one lies outside the image */
inline bool
maskOf(const char* name, const pcl::Indices& indices, cv::Size size, cv::Mat1b& mask)
{
  mask.create(size);
  mask.setTo(0);
  for (const pcl::index_t index : indices) {
    if (index < 0 || index >= size.area()) {
      PCL_ERROR("[hoist::%s::segment] Index %d is outside the cloud of %d points.\n",
                name,
                static_cast<int>(index),
                size.area());
      return false;
    }
    mask(index / size.width, index % size.width) = 255;
  }
  return true;
}

} // namespace detail
} // namespace hoist
