// The camera recovered from points that know their pixels.
#include <hoist/data/estimate_intrinsics.h>
#include <hoist/data/load_frame.h>
#include <hoist/data/point_types.h>
#include <hoist/data/pts_io.h>

#include <support/real_data.h>

#include <gtest/gtest.h>

#include <pcl/exceptions.h>

#include <cmath>
#include <random>

namespace {

using hoist::estimateIntrinsics;
using hoist::Intrinsics;

const Intrinsics truth = [] {
  Intrinsics camera;
  camera.fx = 290.5;
  camera.fy = 301.25;
  camera.cx = 158.75;
  camera.cy = 121.5;
  return camera;
}();

// Points on a bumpy surface, 320 x 240. sigma_px: how far records lie from their
// pixels.
pcl::PointCloud<pcl::PointXYZRGB>
frame(unsigned seed, double sigma_px, double outliers, double missing)
{
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, 1);
  std::uniform_real_distribution<double> unit(0, 1);
  pcl::PointCloud<pcl::PointXYZRGB> cloud(320, 240);
  for (int v = 0; v < 240; ++v)
    for (int u = 0; u < 320; ++u) {
      auto& p = cloud(u, v);
      const double z = 1.5 + 0.3 * std::sin(0.05 * u) + 0.002 * v;
      const bool outlier = unit(random) < outliers;
      const double du = sigma_px * noise(random) + (outlier ? 40 * noise(random) : 0);
      const double dv = sigma_px * noise(random) + (outlier ? 40 * noise(random) : 0);
      const Eigen::Vector3d q = z * truth.ray(u + du, v + dv);
      p.getVector3fMap() = q.cast<float>();
      if (unit(random) < missing)
        p.x = p.y = p.z = std::numeric_limits<float>::quiet_NaN();
    }
  return cloud;
}

void
expectNear(const Intrinsics& camera, double f_tolerance, double c_tolerance)
{
  ASSERT_TRUE(camera.valid());
  EXPECT_NEAR(camera.fx, truth.fx, f_tolerance);
  EXPECT_NEAR(camera.fy, truth.fy, f_tolerance);
  EXPECT_NEAR(camera.cx, truth.cx, c_tolerance);
  EXPECT_NEAR(camera.cy, truth.cy, c_tolerance);
}

TEST(Intrinsics, ExactPointsGiveTheExactCamera)
{
  const Intrinsics camera = estimateIntrinsics(frame(1, 0, 0, 0.2));
  expectNear(camera, 1e-3, 1e-3); // floats: 6e-8 of 300 px, averaged
  EXPECT_LT(camera.rms, 1e-3);
  EXPECT_GT(camera.records, 2000u);
  EXPECT_GT(camera.inliers, camera.records * 9 / 10);
}

TEST(Intrinsics, NoiseAveragesOut)
{
  // Half a pixel over about 4000 records that spread over 320 pixels (sigma 92): the
  // centre is good to 0.5 / sqrt(4000) = 0.008 px, the focal length to 0.008 / 92 * 300
  // = 0.03 px; five sigma and the biweight's loss. Noise in the regressor shrinks f by
  // its share of the variance, 0.25 / 92^2 = 3e-5 (v: 0.25 / 69^2), 0.02 px.
  for (unsigned seed = 1; seed < 6; ++seed) {
    const Intrinsics camera = estimateIntrinsics(frame(seed, 0.5, 0, 0.2));
    expectNear(camera, 0.3, 0.06);
    EXPECT_NEAR(camera.rms, 0.5 * std::sqrt(2.0), 0.1);
  }
}

TEST(Intrinsics, OutliersDoNotCount)
{
  for (unsigned seed = 1; seed < 6; ++seed) {
    const Intrinsics camera = estimateIntrinsics(frame(seed, 0.1, 0.3, 0.1));
    expectNear(camera, 0.2, 0.05);
    EXPECT_LT(camera.inliers, camera.records * 8 / 10);
  }
}

TEST(Intrinsics, RecordsWithPixelsNeedNoGrid)
{
  const auto cloud = frame(3, 0, 0.1, 0.5);
  pcl::PointCloud<hoist::PointXYZRGBUV> records;
  pcl::PointCloud<hoist::PointXYZUV> plain;
  for (std::uint32_t v = 0; v < 240; ++v)
    for (std::uint32_t u = 0; u < 320; ++u) {
      hoist::PointXYZRGBUV p;
      p.getVector3fMap() = cloud(u, v).getVector3fMap();
      p.u = u;
      p.v = v;
      records.push_back(p);
      hoist::PointXYZUV q;
      q.getVector3fMap() = p.getVector3fMap();
      q.u = u;
      q.v = v;
      plain.push_back(q);
    }
  ASSERT_EQ(records.height, 1u);
  expectNear(estimateIntrinsics(records), 0.01, 0.01);
  expectNear(estimateIntrinsics(plain), 0.01, 0.01);
}

TEST(Intrinsics, TooLittleToTell)
{
  pcl::PointCloud<pcl::PointXYZ> row(100, 1);
  EXPECT_THROW((void)estimateIntrinsics(row), pcl::UnorganizedPointCloudException);
  EXPECT_FALSE(estimateIntrinsics(pcl::PointCloud<hoist::PointXYZUV>()).valid());
  pcl::PointCloud<pcl::PointXYZ> cloud(10, 10);
  EXPECT_FALSE(estimateIntrinsics(cloud).valid()); // z = 0 everywhere
  for (auto& p : cloud)
    p.z = 1; // all on one ray
  EXPECT_FALSE(estimateIntrinsics(cloud).valid());
  for (auto& p : cloud)
    p.x = p.y = p.z = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(estimateIntrinsics(cloud).valid());
  const Intrinsics none =
      estimateIntrinsics(Eigen::MatrixX2d(0, 2), Eigen::MatrixX2d(0, 2));
  EXPECT_FALSE(none.valid());
}

TEST(Intrinsics, BumblebeeExcerptGivesItsCamera)
{
  HOIST_SKIP_WITHOUT_REAL_DATA();
  hoist::PTSOptions options;
  options.organize = false;
  pcl::PointCloud<hoist::PointXYZRGBUV> records;
  hoist::readPTS((*hoist::test::realData() / "pts/triclops_excerpt.pts").string(),
                 records,
                 options);
  const Intrinsics camera = estimateIntrinsics(records);
  // its SOURCE.txt: 145.22, 160.345 and 120.006; 29 of 31 records agree
  ASSERT_TRUE(camera.valid());
  EXPECT_NEAR(camera.fx, 145.22, 0.02);
  EXPECT_NEAR(camera.fy, 145.22, 0.02);
  EXPECT_NEAR(camera.cx, 160.345, 0.01);
  EXPECT_NEAR(camera.cy, 120.006, 0.01);
  EXPECT_EQ(camera.records, 31u);
  EXPECT_LE(camera.inliers, 29u);
  EXPECT_GE(camera.inliers, 20u);
}

} // namespace
