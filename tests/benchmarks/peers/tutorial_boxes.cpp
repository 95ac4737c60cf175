#include "peer.h"

#include <pcl/features/moment_of_inertia_estimation.h>
#include <pcl/filters/extract_indices.h>
#include <pcl/filters/statistical_outlier_removal.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <algorithm>

namespace peers {
namespace {

using Points = pcl::PointCloud<pcl::PointXYZRGB>;

constexpr float LEAF = 0.005f; // [m]
constexpr float MIN_SIDE = 0.015f;
constexpr float MAX_SIDE = 0.4f;
constexpr float MIN_SCORE = 0.85f;

/** \brief Takes planes out as long as they are large, as the tutorial does. */
void
removePlanes(Points::Ptr& points)
{
  pcl::SACSegmentation<pcl::PointXYZRGB> sac;
  sac.setOptimizeCoefficients(true);
  sac.setModelType(pcl::SACMODEL_PLANE);
  sac.setMethodType(pcl::SAC_RANSAC);
  sac.setMaxIterations(100);
  sac.setDistanceThreshold(0.01);
  const std::size_t large = points->size() * 3 / 10;
  pcl::ExtractIndices<pcl::PointXYZRGB> extract;
  extract.setNegative(true);
  while (points->size() > large) {
    pcl::PointIndices::Ptr inliers(new pcl::PointIndices);
    pcl::ModelCoefficients plane;
    sac.setInputCloud(points);
    sac.segment(*inliers, plane);
    if (inliers->indices.size() < large)
      return;
    extract.setInputCloud(points);
    extract.setIndices(inliers);
    Points::Ptr rest(new Points);
    extract.filter(*rest);
    points = rest;
  }
}

} // namespace

std::vector<Box>
tutorialBoxes(const Cloud::ConstPtr& cloud)
{
  Points::Ptr points(new Points);
  pcl::VoxelGrid<pcl::PointXYZRGB> grid;
  grid.setInputCloud(cloud);
  grid.setLeafSize(LEAF, LEAF, LEAF);
  grid.filter(*points);
  removePlanes(points);

  Points::Ptr clean(new Points);
  pcl::StatisticalOutlierRemoval<pcl::PointXYZRGB> outliers;
  outliers.setMeanK(20);
  outliers.setStddevMulThresh(2.0);
  outliers.setInputCloud(points);
  outliers.filter(*clean);
  if (clean->empty())
    return {};

  pcl::search::KdTree<pcl::PointXYZRGB>::Ptr tree(
      new pcl::search::KdTree<pcl::PointXYZRGB>);
  tree->setInputCloud(clean);
  pcl::EuclideanClusterExtraction<pcl::PointXYZRGB> extraction;
  extraction.setClusterTolerance(0.01);
  extraction.setMinClusterSize(100);
  extraction.setMaxClusterSize(25000);
  extraction.setSearchMethod(tree);
  extraction.setInputCloud(clean);
  std::vector<pcl::PointIndices> clusters;
  extraction.extract(clusters);

  std::vector<Box> boxes;
  for (const auto& cluster : clusters) {
    pcl::MomentOfInertiaEstimation<pcl::PointXYZRGB> estimation;
    estimation.setInputCloud(clean);
    estimation.setIndices(pcl::make_shared<pcl::PointIndices>(cluster));
    estimation.setAngleStep(360); // only the box is wanted, no other moments
    estimation.compute();
    pcl::PointXYZRGB low, high, position;
    Box box;
    estimation.getOBB(low, high, position, box.axes);
    box.size = high.getVector3fMap() - low.getVector3fMap();
    box.center = position.getVector3fMap();
    if (box.size.minCoeff() < MIN_SIDE || box.size.maxCoeff() > MAX_SIDE)
      continue;
    if (box.axes.determinant() < 0)
      box.axes.col(2) = -box.axes.col(2);
    // points against the half of the box's surface that can be seen
    const Eigen::Vector3f& s = box.size;
    const float half = s[0] * s[1] + s[1] * s[2] + s[2] * s[0];
    box.score =
        std::min(1.f, static_cast<float>(cluster.indices.size()) * LEAF * LEAF / half);
    if (box.score >= MIN_SCORE)
      boxes.push_back(box);
  }
  return boxes;
}

} // namespace peers
