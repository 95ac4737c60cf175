#include <hoist/data/point_types.h>
#include <hoist/recognition/cuboid_feature_extraction.h>

#include <pcl/point_cloud.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace {

// A cuboid of 0.6 x 0.4 x 0.2 m, turned, 3 m from the camera.
hoist::Cuboid
testCuboid()
{
  hoist::Cuboid cuboid;
  cuboid.center = {0.1, -0.2, 3.0};
  cuboid.axes = (Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY()) *
                 Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()))
                    .toRotationMatrix();
  cuboid.size = {0.6, 0.4, 0.2};
  cuboid.size_sigma = {0.004, 0.004, 0.004};
  return cuboid;
}

template <typename PointT>
void
paint(PointT& point, int r, int g, int b)
{
  if constexpr (pcl::traits::has_color<PointT>::value) {
    point.r = static_cast<unsigned char>(r);
    point.g = static_cast<unsigned char>(g);
    point.b = static_cast<unsigned char>(b);
  }
}

// First half of the points: blue, on the cuboid's faces; second half: red, elsewhere.
template <typename PointT>
typename pcl::PointCloud<PointT>::Ptr
testCloud(const hoist::Cuboid& cuboid)
{
  auto cloud = pcl::make_shared<pcl::PointCloud<PointT>>();
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> side(-0.5, 0.5);
  for (int i = 0; i < 400; ++i) {
    Eigen::Vector3d q(side(generator), side(generator), side(generator));
    q[i % 3] = i % 2 == 0 ? 0.5 : -0.5;
    const Eigen::Vector3d p = cuboid.center + cuboid.axes * q.cwiseProduct(cuboid.size);
    PointT point;
    point.getVector3fMap() = p.cast<float>();
    paint(point, 20, 40, 190);
    cloud->push_back(point);
  }
  for (int i = 0; i < 400; ++i) {
    PointT point;
    point.x = static_cast<float>(side(generator));
    point.y = static_cast<float>(side(generator));
    point.z = 5.0f;
    if (i % 10 == 0)
      point.x = point.y = point.z = std::numeric_limits<float>::quiet_NaN();
    paint(point, 220, 20, 30);
    cloud->push_back(point);
  }
  return cloud;
}

template <typename PointT>
class FeatureExtraction : public testing::Test {
};
using PointTypes = testing::Types<pcl::PointXYZ,
                                  pcl::PointXYZI,
                                  pcl::PointXYZRGB,
                                  pcl::PointXYZRGBA,
                                  pcl::PointXYZRGBL,
                                  hoist::PointXYZRGBUV>;
TYPED_TEST_SUITE(FeatureExtraction, PointTypes);

TYPED_TEST(FeatureExtraction, DescribesACuboid)
{
  const hoist::Cuboid cuboid = testCuboid();
  hoist::CuboidFeatureExtraction<TypeParam> extraction;
  extraction.setInputCloud(testCloud<TypeParam>(cuboid));
  extraction.setCuboids({cuboid});
  ASSERT_TRUE(extraction.setMaterial("concrete"));
  std::vector<hoist::CuboidFeatures> features;
  ASSERT_TRUE(extraction.compute(features));
  ASSERT_EQ(features.size(), 1u);
  EXPECT_EQ(features[0].color_name,
            pcl::traits::has_color<TypeParam>::value ? "blue" : "");
  EXPECT_NEAR(features[0].weight, 0.6 * 0.4 * 0.2 * 2400, 1e-9);
  EXPECT_GT(features[0].weight_sigma, 0);
  EXPECT_LT((features[0].orientation.toRotationMatrix() - cuboid.axes).norm(), 1e-12);
  EXPECT_GE(features[0].orientation.w(), 0);
  EXPECT_LT(features[0].lift_normal.dot(features[0].lift_point), 0);

  extraction.setUpDirection({0, -2, 0}); // the length does not matter
  ASSERT_TRUE(extraction.compute(features));
  ASSERT_EQ(features.size(), 1u);
  EXPECT_LT((features[0].lift_normal + cuboid.axes.col(1)).norm(), 1e-12);
}

TYPED_TEST(FeatureExtraction, NoInputNoFeatures)
{
  hoist::CuboidFeatureExtraction<TypeParam> extraction;
  extraction.setCuboids({testCuboid()});
  std::vector<hoist::CuboidFeatures> features(3);
  EXPECT_FALSE(extraction.compute(features));
  EXPECT_TRUE(features.empty());
}

TYPED_TEST(FeatureExtraction, RejectsIndicesOutOfRange)
{
  const auto cloud = testCloud<TypeParam>(testCuboid());
  hoist::CuboidFeatureExtraction<TypeParam> extraction;
  extraction.setInputCloud(cloud);
  extraction.setCuboids({testCuboid()});
  std::vector<hoist::CuboidFeatures> features(3);
  for (const int bad : {-1, static_cast<int>(cloud->size())}) {
    extraction.setIndices(pcl::make_shared<pcl::Indices>(pcl::Indices{0, bad}));
    EXPECT_FALSE(extraction.compute(features));
    EXPECT_TRUE(features.empty());
  }
  extraction.setIndices(pcl::make_shared<pcl::Indices>(pcl::Indices{0}));
  hoist::Cuboid cuboid = testCuboid();
  cuboid.indices = {static_cast<int>(cloud->size())};
  extraction.setCuboids({cuboid});
  EXPECT_FALSE(extraction.compute(features));
}

TYPED_TEST(FeatureExtraction, NoCuboidsIsAnEmptyAnswer)
{
  hoist::CuboidFeatureExtraction<TypeParam> extraction;
  extraction.setInputCloud(testCloud<TypeParam>(testCuboid()));
  std::vector<hoist::CuboidFeatures> features(3);
  EXPECT_TRUE(extraction.compute(features));
  EXPECT_TRUE(features.empty());
}

using Extraction = hoist::CuboidFeatureExtraction<pcl::PointXYZRGB>;

TEST(FeatureExtractionColour, OwnIndicesComeFirst)
{
  hoist::Cuboid cuboid = testCuboid();
  cuboid.indices.resize(400);
  std::iota(cuboid.indices.begin(), cuboid.indices.end(), 400); // the red points
  Extraction extraction;
  extraction.setInputCloud(testCloud<pcl::PointXYZRGB>(cuboid));
  extraction.setCuboids({cuboid});
  std::vector<hoist::CuboidFeatures> features;
  ASSERT_TRUE(extraction.compute(features));
  EXPECT_EQ(features.at(0).color_name, "red");
}

TEST(FeatureExtractionColour, OnlyGivenIndicesCount)
{
  hoist::Cuboid cuboid = testCuboid();
  cuboid.indices.resize(800);
  std::iota(cuboid.indices.begin(), cuboid.indices.end(), 0);
  Extraction extraction;
  extraction.setInputCloud(testCloud<pcl::PointXYZRGB>(cuboid));
  extraction.setCuboids({cuboid});
  auto some = pcl::make_shared<pcl::Indices>(100);
  std::iota(some->begin(), some->end(), 500);
  extraction.setIndices(some);
  std::vector<hoist::CuboidFeatures> features;
  ASSERT_TRUE(extraction.compute(features));
  EXPECT_EQ(features.at(0).color_name, "red");
}

TEST(FeatureExtractionColour, NoPointsNoColour)
{
  hoist::Cuboid cuboid = testCuboid();
  const auto cloud = testCloud<pcl::PointXYZRGB>(cuboid);
  cuboid.center.z() = 20;
  Extraction extraction;
  extraction.setInputCloud(cloud);
  extraction.setCuboids({cuboid});
  std::vector<hoist::CuboidFeatures> features;
  ASSERT_TRUE(extraction.compute(features));
  EXPECT_EQ(features.at(0).color_name, "");
}

TEST(FeatureExtractionSettings, UnknownMaterialChangesNothing)
{
  Extraction extraction;
  EXPECT_TRUE(extraction.setMaterial("steel"));
  EXPECT_FALSE(extraction.setMaterial("kryptonite"));
  EXPECT_EQ(extraction.getMaterial(), "steel");
  EXPECT_TRUE(extraction.setMaterial(""));
  extraction.setInputCloud(testCloud<pcl::PointXYZRGB>(testCuboid()));
  extraction.setCuboids({testCuboid()});
  std::vector<hoist::CuboidFeatures> features;
  ASSERT_TRUE(extraction.compute(features));
  EXPECT_EQ(features.at(0).weight, 0);
  extraction.setSurfaceTolerance(0);
  EXPECT_FALSE(extraction.compute(features));
}

// The quaternion of the canonical axes does not jump when a box is seen again with
// a little noise, nor with its axes named otherwise.
TEST(FeatureExtractionOrientation, DoesNotFlipBetweenFrames)
{
  std::mt19937 generator(5);
  std::normal_distribution<double> noise(0.0, 0.002);
  hoist::Cuboid first = testCuboid();
  hoist::canonicalize(first);
  const Eigen::Quaterniond reference(first.axes);
  for (int i = 0; i < 100; ++i) {
    hoist::Cuboid cuboid = testCuboid();
    const int shift = i % 3;
    Eigen::Matrix3d axes = cuboid.axes;
    Eigen::Vector3d size = cuboid.size;
    for (int k = 0; k < 3; ++k) {
      cuboid.axes.col(k) = axes.col((k + shift) % 3);
      cuboid.size[k] = size[(k + shift) % 3] + noise(generator);
    }
    if (i % 2 == 0) { // half a turn about one axis: the same box
      cuboid.axes.col(0) *= -1;
      cuboid.axes.col(1) *= -1;
    }
    cuboid.axes =
        Eigen::AngleAxisd(noise(generator), Eigen::Vector3d::UnitZ()) * cuboid.axes;
    hoist::canonicalize(cuboid);
    EXPECT_LT(reference.angularDistance(Eigen::Quaterniond(cuboid.axes)), 0.02) << i;
  }
}

} // namespace
