#pragma once

#include "viewer/scene.h"

#include <pcl/PCLPointCloud2.h>
#include <pcl/visualization/point_cloud_color_handlers.h>

#include <vector>

namespace hoist {

using CloudHandler = pcl::visualization::PointCloudColorHandler<pcl::PCLPointCloud2>;

/** \brief All ways to colour a scene's cloud, in the order of the keys: one colour, x,
 * y, z, rgb, by object, then the other fields of the file. \param blob the scene's
 * cloud, of type PointXYZRGB */
std::vector<CloudHandler::ConstPtr>
cloudHandlers(const pcl::PCLPointCloud2::ConstPtr& blob, const Scene& scene);

} // namespace hoist
