#pragma once

#include <Eigen/Core>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <vector>

/** \brief What a PCL engineer builds without hoist, to measure hoist against. */
namespace peers {

using Cloud = pcl::PointCloud<pcl::PointXYZRGB>;

/** \brief Pinhole intrinsics [px]. */
struct Camera {
  float fx, fy, cx, cy;
};

/** \brief A box in the camera frame, metres; size(i) lies along column i of axes. */
struct Box {
  Eigen::Vector3f center;
  Eigen::Matrix3f axes; ///< orthonormal, determinant +1
  Eigen::Vector3f size;
  float score = 1; ///< in [0, 1]
};

/** \brief The tutorials' way: voxel grid, plane removal, outlier removal, Euclidean
 *  clusters, box of the moments of inertia.
 *  \param cloud organized or not, NaN where nothing was measured */
std::vector<Box> tutorialBoxes(const Cloud::ConstPtr& cloud);

/** \brief Clusters on the organized cloud, sequential RANSAC planes in each of them,
 *  boxes from perpendicular faces.
 *  \param cloud organized, NaN where nothing was measured */
std::vector<Box> ransacBoxes(const Cloud::ConstPtr& cloud, const Camera& camera);

/** \brief Integral image normals, OrganizedMultiPlaneSegmentation, boxes from
 *  perpendicular faces.
 *  \param cloud organized, NaN where nothing was measured */
std::vector<Box> multiPlaneBoxes(const Cloud::ConstPtr& cloud, const Camera& camera);

} // namespace peers
