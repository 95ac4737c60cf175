#include "faces.h"

#include <pcl/features/integral_image_normal.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/euclidean_cluster_comparator.h>
#include <pcl/segmentation/organized_connected_component_segmentation.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace peers {
namespace {

using Points = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::Normal>;
using Labels = pcl::PointCloud<pcl::Label>;

constexpr std::uint32_t STEP = 2;       // planes are searched on every second pixel
constexpr float OBJECT_HEIGHT = 0.006f; // objects begin so far over the support [m]
constexpr std::size_t MIN_CLUSTER = 120;
constexpr std::size_t MIN_PLANE = 50;
constexpr std::size_t RANSAC_POINTS = 500;
constexpr int MAX_PLANES = 12;             // of a cluster
constexpr float MIN_NORMAL_COSINE = 0.88f; // of a point on a plane: 28 degrees

/** \brief Pixels belong together if they are of one plane and near each other. */
class FaceComparator : public pcl::Comparator<pcl::PointXYZ> {
public:
  explicit FaceComparator(const std::vector<int>& plane_of) : plane_of_(plane_of) {}

  bool
  compare(int a, int b) const override
  {
    return plane_of_[a] >= 0 && plane_of_[a] == plane_of_[b] &&
           ((*input_)[a].getVector3fMap() - (*input_)[b].getVector3fMap())
                   .squaredNorm() < 0.02f * 0.02f;
  }

private:
  const std::vector<int>& plane_of_;
};

Points::Ptr
thinned(const Cloud& cloud)
{
  Points::Ptr thin(new Points(cloud.width / STEP, cloud.height / STEP));
  for (std::uint32_t v = 0; v < thin->height; ++v)
    for (std::uint32_t u = 0; u < thin->width; ++u)
      (*thin)(u, v).getVector3fMap() = cloud(u * STEP, v * STEP).getVector3fMap();
  thin->is_dense = false;
  return thin;
}

Normals::Ptr
normalsOf(const Points::ConstPtr& points)
{
  pcl::IntegralImageNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setNormalEstimationMethod(estimation.AVERAGE_3D_GRADIENT);
  estimation.setMaxDepthChangeFactor(0.02f);
  estimation.setNormalSmoothingSize(8.f);
  estimation.setInputCloud(points);
  Normals::Ptr normals(new Normals);
  estimation.compute(*normals);
  return normals;
}

std::vector<pcl::PointIndices>
clustersOf(const Points::ConstPtr& objects)
{
  pcl::EuclideanClusterComparator<pcl::PointXYZ, pcl::Label>::Ptr comparator(
      new pcl::EuclideanClusterComparator<pcl::PointXYZ, pcl::Label>);
  comparator->setInputCloud(objects);
  comparator->setDistanceThreshold(0.02f, false);
  pcl::OrganizedConnectedComponentSegmentation<pcl::PointXYZ, pcl::Label> segmentation(
      comparator);
  segmentation.setInputCloud(objects);
  Labels labels;
  std::vector<pcl::PointIndices> clusters;
  segmentation.segment(labels, clusters);
  return clusters;
}

/** \brief Takes planes out of a cluster, the largest first.
 *  \param plane_of number of the plane for every pixel, -1 for none; appended to */
void
splitIntoPlanes(const Points::ConstPtr& points,
                const Normals::ConstPtr& normals,
                pcl::Indices rest,
                int& planes,
                std::vector<int>& plane_of)
{
  pcl::SACSegmentation<pcl::PointXYZ> sac;
  sac.setModelType(pcl::SACMODEL_PLANE);
  sac.setMethodType(pcl::SAC_RANSAC);
  sac.setDistanceThreshold(0.006);
  sac.setMaxIterations(80);
  sac.setInputCloud(points);
  for (int k = 0; k < MAX_PLANES && rest.size() >= MIN_PLANE; ++k) {
    pcl::IndicesPtr sample(new pcl::Indices);
    const std::size_t step = rest.size() / RANSAC_POINTS + 1;
    for (std::size_t i = 0; i < rest.size(); i += step)
      sample->push_back(rest[i]);
    pcl::search::KdTree<pcl::PointXYZ>::Ptr tree(
        new pcl::search::KdTree<pcl::PointXYZ>(false));
    tree->setInputCloud(points, sample);
    sac.setSamplesMaxDist(0.04, tree); // three points of one face, most often
    sac.setIndices(sample);
    pcl::PointIndices inliers;
    pcl::ModelCoefficients plane;
    sac.segment(inliers, plane);
    if (inliers.indices.size() * step < MIN_PLANE)
      return;
    const Eigen::Vector3f normal = Eigen::Vector3f::Map(plane.values.data());
    pcl::Indices others;
    for (const int i : rest) {
      const auto& p = (*points)[i].getVector3fMap();
      const float distance = std::abs(normal.dot(p) + plane.values[3]);
      const float cosine = std::abs(normal.dot((*normals)[i].getNormalVector3fMap()));
      if (distance < tolerance(p.z()) && cosine > MIN_NORMAL_COSINE)
        plane_of[i] = planes;
      else
        others.push_back(i);
    }
    ++planes;
    if (others.size() == rest.size())
      return;
    rest.swap(others);
  }
}

} // namespace

std::vector<Box>
ransacBoxes(const Cloud::ConstPtr& cloud, const Camera& camera)
{
  Scene scene{cloud, camera, {}};
  if (!findSupport(*cloud, scene.support))
    return {};
  const Points::Ptr points = thinned(*cloud);
  const Normals::Ptr normals = normalsOf(points);
  Points::Ptr objects(new Points(*points));
  for (auto& p : *objects)
    if (!(scene.support.head<3>().dot(p.getVector3fMap()) + scene.support[3] >
          OBJECT_HEIGHT))
      p.x = p.y = p.z = std::numeric_limits<float>::quiet_NaN();

  std::vector<int> plane_of(points->size(), -1);
  int planes = 0;
  for (auto& cluster : clustersOf(objects)) {
    auto& indices = cluster.indices;
    indices.erase(
        std::remove_if(indices.begin(),
                       indices.end(),
                       [&](int i) { return !std::isfinite((*normals)[i].normal_x); }),
        indices.end());
    if (indices.size() >= MIN_CLUSTER)
      splitIntoPlanes(points, normals, indices, planes, plane_of);
  }

  // A plane may cut several objects: its connected parts are faces
  for (std::size_t i = 0; i < objects->size(); ++i)
    if (plane_of[i] < 0)
      (*objects)[i].x = std::numeric_limits<float>::quiet_NaN();
  pcl::shared_ptr<FaceComparator> comparator(new FaceComparator(plane_of));
  comparator->setInputCloud(objects);
  pcl::OrganizedConnectedComponentSegmentation<pcl::PointXYZ, pcl::Label> segmentation(
      comparator);
  segmentation.setInputCloud(objects);
  Labels labels;
  std::vector<pcl::PointIndices> parts;
  segmentation.segment(labels, parts);
  std::vector<Face> faces;
  for (const auto& part : parts) {
    if (part.indices.size() < MIN_PLANE)
      continue;
    Face face;
    for (const int i : part.indices) {
      const std::uint32_t u = static_cast<std::uint32_t>(i) % points->width * STEP;
      const std::uint32_t v = static_cast<std::uint32_t>(i) / points->width * STEP;
      face.pixels.push_back(static_cast<int>(v * cloud->width + u));
    }
    faces.push_back(std::move(face));
  }
  growFaces(scene, faces);
  return boxesFromFaces(scene, faces);
}

} // namespace peers
