// Centroid, lifting pose, weight, distance to the surface.
#include <hoist/recognition/centroid.h>
#include <hoist/recognition/lifting.h>
#include <hoist/recognition/surface.h>
#include <hoist/recognition/weight.h>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

namespace {

hoist::Cuboid
randomCuboid(std::mt19937& generator)
{
  std::uniform_real_distribution<double> side(0.05, 2.0), any(-1.0, 1.0);
  hoist::Cuboid cuboid;
  cuboid.center = {any(generator), any(generator), 3.0 + any(generator)};
  Eigen::Quaterniond q(any(generator), any(generator), any(generator), any(generator));
  cuboid.axes = q.normalized().toRotationMatrix();
  cuboid.size = {side(generator), side(generator), side(generator)};
  return cuboid;
}

class Seeds : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Geometry, Seeds, testing::Range(0, 20));

// Rounding only: coordinates of a few metres.
constexpr double rounding = 1e-12;

TEST_P(Seeds, CentroidFromAnyVertexIsTheCentre)
{
  std::mt19937 generator(GetParam());
  const hoist::Cuboid cuboid = randomCuboid(generator);
  const auto corners = cuboid.corners();
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3d centre = hoist::centroidFromVertex(
        corners.col(k), {corners.col(k ^ 1), corners.col(k ^ 2), corners.col(k ^ 4)});
    EXPECT_LT((centre - cuboid.center).norm(), rounding);
  }
}

TEST_P(Seeds, CentroidFromAnyMiddleEdgeIsTheCentre)
{
  std::mt19937 generator(GetParam());
  const hoist::Cuboid cuboid = randomCuboid(generator);
  const auto corners = cuboid.corners();
  for (int k = 0; k < 8; ++k)
    for (const int middle : {1, 2, 4})
      for (const int side : {1, 2, 4}) {
        if (side == middle)
          continue;
        const int other = 7 ^ middle ^ side;
        const Eigen::Vector3d centre = hoist::centroidFromVertices(
            corners.col(k ^ side), corners.col(k ^ middle ^ other));
        EXPECT_LT((centre - cuboid.center).norm(), rounding);
      }
}

TEST_P(Seeds, UpwardFaceHasTheHighestCentreOfAllFaces)
{
  std::mt19937 generator(GetParam());
  const hoist::Cuboid cuboid = randomCuboid(generator);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const Eigen::Vector3d up =
      Eigen::Vector3d(any(generator), any(generator), any(generator)).normalized();
  const hoist::LiftPose pose = hoist::upwardFace(cuboid, up);
  EXPECT_NEAR(pose.normal.norm(), 1.0, rounding);
  // the best of six directions of an orthonormal frame is within acos(1/sqrt 3)
  EXPECT_GE(pose.normal.dot(up), 1.0 / std::sqrt(3.0) - rounding);
  EXPECT_NEAR(hoist::distanceToSurface(cuboid, pose.point), 0.0, rounding);
  // outward: a step along the normal leaves the box
  EXPECT_NEAR(
      hoist::distanceToSurface(cuboid, pose.point + 0.5 * pose.normal), 0.5, rounding);
}

TEST_P(Seeds, CameraFacingFaceIsVisibleFromTheCamera)
{
  std::mt19937 generator(GetParam());
  hoist::Cuboid cuboid = randomCuboid(generator);
  cuboid.center.z() += 5.0; // the camera is outside
  const hoist::LiftPose pose = hoist::cameraFacingFace(cuboid);
  EXPECT_LT(pose.normal.dot(pose.point), 0.0);
}

TEST(Lifting, ReportsWhetherTheFaceWasSeen)
{
  hoist::Cuboid cuboid;
  cuboid.center = {0, 0, 3};
  cuboid.size = {1, 1, 1};
  cuboid.observed_faces[5] = true; // -axis 2, towards the camera
  EXPECT_TRUE(hoist::cameraFacingFace(cuboid).observed);
  EXPECT_EQ(hoist::cameraFacingFace(cuboid).face, 5);
  EXPECT_FALSE(hoist::upwardFace(cuboid, {0, -1, 0}).observed);
  EXPECT_EQ(hoist::upwardFace(cuboid, {0, -1, 0}).face, 3);
}

TEST_P(Seeds, DistanceToSurfaceAgreesWithADenseSampling)
{
  std::mt19937 generator(GetParam());
  hoist::Cuboid cuboid = randomCuboid(generator);
  std::uniform_real_distribution<double> any(-2.0, 2.0);
  const Eigen::Vector3d point =
      cuboid.center + Eigen::Vector3d(any(generator), any(generator), any(generator));
  constexpr int n = 100;
  double nearest = 1e9;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-0.5, 0.5})
      for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) {
          Eigen::Vector3d q;
          q[axis] = sign;
          q[(axis + 1) % 3] = i / double(n) - 0.5;
          q[(axis + 2) % 3] = j / double(n) - 0.5;
          const Eigen::Vector3d p =
              cuboid.center + cuboid.axes * q.cwiseProduct(cuboid.size);
          nearest = std::min(nearest, (p - point).norm());
        }
  const double distance = hoist::distanceToSurface(cuboid, point);
  EXPECT_LE(distance, nearest + rounding);
  // half a grid diagonal of the largest face
  EXPECT_GE(distance, nearest - 0.5 * std::sqrt(2.0) * cuboid.size.maxCoeff() / n);
}

TEST(Weight, OneCubicMetreWeighsItsDensity)
{
  hoist::Cuboid cuboid;
  cuboid.size = {2.0, 1.0, 0.5};
  cuboid.size_sigma = {0.02, 0.02, 0.01};
  for (const hoist::Material& material : hoist::materials())
    EXPECT_NEAR(hoist::estimateWeight(cuboid, material).value, material.density, 1e-9);
  EXPECT_EQ(hoist::findMaterial("concrete")->density, 2400);
  EXPECT_EQ(hoist::findMaterial("steel")->density, 7850);
  EXPECT_EQ(hoist::findMaterial("kryptonite"), nullptr);
}

TEST(Weight, TableIsConsistent)
{
  std::set<std::string> names;
  for (const hoist::Material& m : hoist::materials()) {
    EXPECT_LT(m.density_low, m.density_high) << m.name;
    EXPECT_LE(m.density_low, m.density) << m.name;
    EXPECT_GE(m.density_high, m.density) << m.name;
    EXPECT_TRUE(names.insert(m.name).second) << m.name;
    EXPECT_EQ(hoist::findMaterial(m.name), &m);
  }
}

// The first order formula against the spread of drawn weights.
TEST(Weight, SigmaIsTheSpreadOfDrawnWeights)
{
  hoist::Cuboid cuboid;
  cuboid.size = {0.8, 0.4, 0.2};
  cuboid.size_sigma = {0.01, 0.008, 0.006};
  const hoist::Material& material = *hoist::findMaterial("concrete");
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> density(material.density_low,
                                                 material.density_high);
  constexpr int n = 20000;
  double sum = 0, sum2 = 0;
  for (int i = 0; i < n; ++i) {
    double w = density(generator);
    for (int k = 0; k < 3; ++k)
      w *= cuboid.size[k] + cuboid.size_sigma[k] * normal(generator);
    sum += w;
    sum2 += w * w;
  }
  const double spread = std::sqrt(sum2 / n - sum / n * (sum / n));
  // second order terms and the estimate of a spread from n draws: 3 % covers both
  EXPECT_NEAR(hoist::estimateWeight(cuboid, material).sigma, spread, 0.03 * spread);
}

TEST(Weight, SigmaIsUnknownWhereTheSizesHaveNone)
{
  hoist::Cuboid cuboid;
  cuboid.size = {1, 1, 1};
  const hoist::Weight weight =
      hoist::estimateWeight(cuboid, *hoist::findMaterial("wood"));
  EXPECT_GT(weight.value, 0);
  EXPECT_TRUE(std::isnan(weight.sigma));
}

} // namespace
