#pragma once

#include <hoist/data/export.h>
#include <hoist/data/intrinsics.h>

#include <opencv2/core.hpp>

#include <pcl/memory.h>
#include <pcl/point_cloud.h>

namespace hoist {

/** \brief A frame as image buffers, converted once and shared by all stages.
 *
 * All images have the frame's height x width; pixel (u, v) is the cloud's index
 * v * width + u. The buffers keep their memory from frame to frame when the size stays.
 */
struct FrameImages {
  using Ptr = pcl::shared_ptr<FrameImages>;
  using ConstPtr = pcl::shared_ptr<const FrameImages>;

  cv::Mat3f points; ///< x, y, z in the camera frame [m]; NaN where not measured
  cv::Mat1f
      inverse_depth;     ///< 1 / z [1/m]; 0 where not measured. A plane is linear in it
  cv::Mat3b bgr;         ///< colour, OpenCV's channel order; empty without colour
  cv::Mat1b gray;        ///< luma 0.299 R + 0.587 G + 0.114 B; empty without colour
  Intrinsics intrinsics; ///< recovered from the points; see estimateIntrinsics

  int
  width() const
  {
    return points.cols;
  }

  int
  height() const
  {
    return points.rows;
  }

  bool
  hasColor() const
  {
    return !gray.empty();
  }
};

/** \brief Fills \a images from an organized cloud.
 *
 * \param cloud organized (height > 1); colour is taken from fields rgb, rgba or, as
 *        grey, intensity
 * \param images buffers to fill; reused when the size is unchanged
 * \throws pcl::UnorganizedPointCloudException if the cloud is not organized
 */
template <typename PointT>
void toFrameImages(const pcl::PointCloud<PointT>& cloud, FrameImages& images);

} // namespace hoist

#ifdef PCL_NO_PRECOMPILE
#include <hoist/data/impl/frame_images.hpp>
#endif
