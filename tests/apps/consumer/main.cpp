// Finds no cuboid in a wall, which is what a wall has, through the installed headers
// and libraries of all modules.
#include <hoist/data/point_types.h>
#include <hoist/recognition/cuboid_feature_extraction.h>
#include <hoist/segmentation/cuboid_segmentation.h>

#include <iostream>

int
main()
{
  constexpr int width = 160, height = 120;
  constexpr float focal = 131.25f;
  auto cloud = pcl::make_shared<pcl::PointCloud<hoist::PointXYZRGBUV>>(width, height);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      hoist::PointXYZRGBUV& p = (*cloud)(u, v);
      p.z = 2.0f;
      p.x = (static_cast<float>(u) - 79.5f) * p.z / focal;
      p.y = (static_cast<float>(v) - 59.5f) * p.z / focal;
      p.r = p.g = p.b = 180;
    }

  hoist::CuboidSegmentation<hoist::PointXYZRGBUV> segmentation;
  segmentation.setInputCloud(cloud);
  std::vector<hoist::Cuboid> cuboids;
  if (!segmentation.segment(cuboids))
    return 1;

  hoist::CuboidFeatureExtraction<hoist::PointXYZRGBUV> extraction;
  extraction.setInputCloud(cloud);
  extraction.setCuboids(cuboids);
  std::vector<hoist::CuboidFeatures> features;
  if (!extraction.compute(features) || features.size() != cuboids.size())
    return 1;
  std::cout << cuboids.size() << " cuboids\n";
  return cuboids.empty() ? 0 : 1;
}
