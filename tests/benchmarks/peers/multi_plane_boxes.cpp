#include "faces.h"

#include <pcl/features/integral_image_normal.h>
#include <pcl/segmentation/organized_multi_plane_segmentation.h>

#include <utility>

namespace peers {

std::vector<Box>
multiPlaneBoxes(const Cloud::ConstPtr& cloud, const Camera& camera)
{
  Scene scene{cloud, camera, {}};
  if (!findSupport(*cloud, scene.support))
    return {};
  pcl::IntegralImageNormalEstimation<pcl::PointXYZRGB, pcl::Normal> estimation;
  estimation.setNormalEstimationMethod(estimation.AVERAGE_3D_GRADIENT);
  estimation.setMaxDepthChangeFactor(0.01f);
  estimation.setNormalSmoothingSize(15.f);
  estimation.setInputCloud(cloud);
  pcl::PointCloud<pcl::Normal>::Ptr normals(new pcl::PointCloud<pcl::Normal>);
  estimation.compute(*normals);

  pcl::OrganizedMultiPlaneSegmentation<pcl::PointXYZRGB, pcl::Normal, pcl::Label>
      segmentation;
  segmentation.setMinInliers(200);
  segmentation.setAngularThreshold(pcl::deg2rad(4.0));
  segmentation.setDistanceThreshold(0.02);
  segmentation.setMaximumCurvature(0.01);
  segmentation.setInputNormals(normals);
  segmentation.setInputCloud(cloud);
  std::vector<pcl::ModelCoefficients> planes;
  std::vector<pcl::PointIndices> inliers;
  segmentation.segment(planes, inliers);

  std::vector<Face> faces;
  for (auto& part : inliers) {
    Face face;
    for (const int i : part.indices)
      if (height(scene, (*cloud)[i]) > 0.006f) // the rest is the support plane
        face.pixels.push_back(i);
    if (face.pixels.size() >= part.indices.size() / 2)
      faces.push_back(std::move(face));
  }
  growFaces(scene, faces);
  return boxesFromFaces(scene, faces);
}

} // namespace peers
