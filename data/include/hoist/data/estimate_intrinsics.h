#pragma once

#include <hoist/data/export.h>
#include <hoist/data/intrinsics.h>

#include <Eigen/Core>

#include <opencv2/core.hpp>

#include <pcl/point_cloud.h>

#include <vector>

namespace hoist {

/** \brief Recovers the camera from points that know their pixels.
 *
 * Least squares of u = fx x/z + cx and v = fy y/z + cy, reweighted with Tukey's
 * biweight at a scale from the median absolute residual, so that repeated or shifted
 * records (real Bumblebee files have them) do not count.
 *
 * \param rays  #rays by 2: x/z and y/z of each record
 * \param pixels #rays by 2: u and v of each record [px]
 * \return rms and inliers are filled too; valid() is false when fewer than 8 records or
 *         when the records do not span both directions of the image
 */
HOIST_DATA_EXPORT Intrinsics
estimateIntrinsics(const Eigen::Ref<const Eigen::MatrixX2d>& rays,
                   const Eigen::Ref<const Eigen::MatrixX2d>& pixels);

/** \brief The same from an image of points, height x width, NaN where not measured.
 *
 * Uses a regular subset of at most \a max_records pixels.
 */
HOIST_DATA_EXPORT Intrinsics estimateIntrinsics(const cv::Mat3f& points,
                                                int max_records = 4096);

/** \brief The same from a cloud: organized, or of a type with fields u and v.
 *
 * Fields u and v are taken where PointT has them and the cloud is not organized, else
 * the index is the pixel. Points that are not finite or have z <= 0 do not count. Uses
 * a regular subset of at most \a max_records points. \throws
 * pcl::UnorganizedPointCloudException if the cloud has neither a grid nor pixels
 */
template <typename PointT>
Intrinsics estimateIntrinsics(const pcl::PointCloud<PointT>& cloud,
                              int max_records = 4096);

} // namespace hoist

#ifdef PCL_NO_PRECOMPILE
#include <hoist/data/impl/estimate_intrinsics.hpp>
#endif
