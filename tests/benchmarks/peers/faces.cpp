#include "faces.h"

#include <pcl/common/centroid.h>
#include <pcl/common/eigen.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace peers {
namespace {

constexpr int GROWTH_PIXELS = 9;         // how far from a patch its face may reach
constexpr float SUPPORT_MARGIN = 0.004f; // lower points are the support plane's [m]
constexpr std::size_t MIN_FACE_PIXELS = 250;
constexpr float SIGHT_TOLERANCES = 1.4f; // a point further off is another surface's
constexpr float JOIN_DISTANCE = 0.01f;   // between patches of one plane [m]
constexpr float JOIN_COSINE = 0.99f;     // of their normals

void
fitPlane(const Cloud& cloud, Face& face)
{
  Eigen::Matrix3f covariance;
  Eigen::Vector4f mean = Eigen::Vector4f::Zero();
  pcl::computeMeanAndCovarianceMatrix(cloud, face.pixels, covariance, mean);
  float value = 0;
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  pcl::eigen33(covariance, value, normal);
  face.centroid = mean.head<3>();
  float d = -normal.dot(face.centroid);
  if (d < 0) { // towards the camera
    normal = -normal;
    d = -d;
  }
  face.plane = Eigen::Vector4f(normal[0], normal[1], normal[2], d);
}

} // namespace

bool
findSupport(const Cloud& cloud, Eigen::Vector4f& plane)
{
  pcl::PointCloud<pcl::PointXYZ>::Ptr sparse(new pcl::PointCloud<pcl::PointXYZ>);
  for (std::uint32_t v = 0; v < cloud.height; v += 8)
    for (std::uint32_t u = 0; u < cloud.width; u += 8) {
      const auto& p = cloud(u, v);
      if (std::isfinite(p.z))
        sparse->emplace_back(p.x, p.y, p.z);
    }
  if (sparse->size() < 100)
    return false;
  pcl::SACSegmentation<pcl::PointXYZ> sac;
  sac.setModelType(pcl::SACMODEL_PLANE);
  sac.setMethodType(pcl::SAC_RANSAC);
  sac.setDistanceThreshold(0.008);
  sac.setMaxIterations(200);
  sac.setInputCloud(sparse);
  pcl::PointIndices inliers;
  pcl::ModelCoefficients coefficients;
  sac.segment(inliers, coefficients);
  if (inliers.indices.empty())
    return false;
  plane = Eigen::Vector4f::Map(coefficients.values.data());
  if (plane[3] < 0)
    plane = -plane;
  return true;
}

void
growFaces(const Scene& scene, std::vector<Face>& faces)
{
  const Cloud& cloud = *scene.cloud;
  const int width = static_cast<int>(cloud.width);
  const int rows = static_cast<int>(cloud.height);
  std::vector<int> owner(cloud.size(), -1);
  pcl::Indices front;
  pcl::Indices next;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    fitPlane(cloud, faces[f]);
    for (const int i : faces[f].pixels)
      owner[i] = static_cast<int>(f);
    front.insert(front.end(), faces[f].pixels.begin(), faces[f].pixels.end());
  }
  const int steps[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  // All faces at the same pace, so that none runs over its neighbour
  for (int ring = 0; ring < GROWTH_PIXELS; ++ring) {
    next.clear();
    for (const int i : front) {
      const int u = i % width;
      const int v = i / width;
      for (const auto& step : steps) {
        const int un = u + step[0];
        const int vn = v + step[1];
        if (un < 0 || vn < 0 || un >= width || vn >= rows)
          continue;
        const int n = vn * width + un;
        const auto& p = cloud[n];
        if (owner[n] >= 0 || !std::isfinite(p.z))
          continue;
        Face& face = faces[owner[i]];
        const float distance =
            face.plane.head<3>().dot(p.getVector3fMap()) + face.plane[3];
        if (std::abs(distance) > tolerance(p.z) || height(scene, p) < SUPPORT_MARGIN)
          continue;
        owner[n] = owner[i];
        face.pixels.push_back(n);
        next.push_back(n);
      }
    }
    front.swap(next);
  }
  for (std::size_t f = 0; f < faces.size(); ++f) {
    Face& face = faces[f];
    if (face.pixels.size() < MIN_FACE_PIXELS) {
      face.pixels.clear();
      continue;
    }
    fitPlane(cloud, face);
    for (const int i : face.pixels) {
      const int u = i % width;
      const int v = i / width;
      if (u == 0 || v == 0 || u + 1 == width || v + 1 == rows ||
          owner[i - 1] != owner[i] || owner[i + 1] != owner[i] ||
          owner[i - width] != owner[i] || owner[i + width] != owner[i])
        face.border.push_back(i);
    }
  }
  faces.erase(std::remove_if(faces.begin(),
                             faces.end(),
                             [](const Face& face) { return face.pixels.empty(); }),
              faces.end());
  for (std::size_t f = 0; f < faces.size(); ++f)
    faces[f].parts = {static_cast<int>(f)};
}

Sight
look(const Scene& scene, const Eigen::Vector3f& point)
{
  if (point.z() <= 0)
    return Sight::none;
  const Cloud& cloud = *scene.cloud;
  const Camera& camera = scene.camera;
  const auto u = std::lround(camera.fx * point.x() / point.z() + camera.cx);
  const auto v = std::lround(camera.fy * point.y() / point.z() + camera.cy);
  if (u < 0 || v < 0 || u >= static_cast<long>(cloud.width) ||
      v >= static_cast<long>(cloud.height))
    return Sight::none;
  const float behind = cloud(static_cast<int>(u), static_cast<int>(v)).z - point.z();
  const float limit = SIGHT_TOLERANCES * tolerance(point.z());
  if (!std::isfinite(behind))
    return Sight::none;
  return behind < -limit  ? Sight::occluded
         : behind > limit ? Sight::contradiction
                          : Sight::support;
}

void
joinFaces(const Scene& scene, std::vector<Face>& faces)
{
  const std::size_t count = faces.size();
  for (std::size_t a = 0; a < count; ++a)
    for (std::size_t b = a + 1; b < count; ++b) {
      const Eigen::Vector3f between = faces[b].centroid - faces[a].centroid;
      if (faces[a].plane.head<3>().dot(faces[b].plane.head<3>()) < JOIN_COSINE ||
          std::abs(faces[a].plane.head<3>().dot(between)) > JOIN_DISTANCE ||
          std::abs(faces[b].plane.head<3>().dot(between)) > JOIN_DISTANCE)
        continue;
      constexpr int SAMPLES = 40;
      int occluded = 0;
      int contradicted = 0;
      for (int i = 1; i < SAMPLES; ++i) {
        const Sight sight = look(
            scene, faces[a].centroid + between * (static_cast<float>(i) / SAMPLES));
        occluded += sight == Sight::occluded;
        contradicted += sight == Sight::contradiction;
      }
      if (occluded < 3 || contradicted > 2)
        continue;
      Face face = faces[a];
      const Face& other = faces[b];
      face.pixels.insert(face.pixels.end(), other.pixels.begin(), other.pixels.end());
      face.border.insert(face.border.end(), other.border.begin(), other.border.end());
      face.parts.insert(face.parts.end(), other.parts.begin(), other.parts.end());
      fitPlane(*scene.cloud, face);
      faces.push_back(std::move(face));
    }
}

DepthCheck
checkDepth(const Scene& scene, const Box& box)
{
  constexpr int GRID = 12;
  DepthCheck check;
  std::array<int, 4> sum{};
  for (int axis = 0; axis < 3; ++axis) {
    // the one of the two faces that may look at the camera
    Eigen::Vector3f normal = box.axes.col(axis);
    if (normal.dot(box.center) > 0)
      normal = -normal;
    const Eigen::Vector3f middle = box.center + normal * box.size[axis] / 2;
    if (normal.dot(middle) > -0.15f * middle.norm()) // grazing, or turned away
      continue;
    const int a = (axis + 1) % 3;
    const int b = (axis + 2) % 3;
    std::array<int, 4> seen{}; // by Sight
    for (int i = 0; i < GRID; ++i)
      for (int j = 0; j < GRID; ++j) {
        const float s = 0.94f * ((i + 0.5f) / GRID - 0.5f);
        const float t = 0.94f * ((j + 0.5f) / GRID - 0.5f);
        const Eigen::Vector3f p = middle + box.axes.col(a) * (s * box.size[a]) +
                                  box.axes.col(b) * (t * box.size[b]);
        ++seen[static_cast<std::size_t>(look(scene, p))];
      }
    for (std::size_t k = 0; k < sum.size(); ++k)
      sum[k] += seen[k];
    if (seen[1] + seen[3] > 0)
      check.worst_face =
          std::min(check.worst_face,
                   static_cast<float>(seen[1]) / static_cast<float>(seen[1] + seen[3]));
  }
  const int all = sum[0] + sum[1] + sum[2] + sum[3];
  if (all > 0) {
    check.support = static_cast<float>(sum[1]) / static_cast<float>(all);
    check.occluded = static_cast<float>(sum[2]) / static_cast<float>(all);
    check.contradiction = static_cast<float>(sum[3]) / static_cast<float>(all);
  }
  return check;
}

} // namespace peers
