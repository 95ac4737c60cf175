// A user's own point type works through the impl headers, without PCL_NO_PRECOMPILE.
#include <hoist/segmentation/impl/cuboid_segmentation.hpp>
#include <hoist/segmentation/impl/line_segment_extraction.hpp>

#include "scene_frames.h"

#include <gtest/gtest.h>

struct EIGEN_ALIGN16 TestPoint {
  PCL_ADD_POINT4D;
  PCL_ADD_RGB;
  float confidence = 0;
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};
POINT_CLOUD_REGISTER_POINT_STRUCT(
    TestPoint,
    (float, x, x)(float, y, y)(float, z, z)(std::uint32_t, rgba, rgba)(float,
                                                                       confidence,
                                                                       confidence))

namespace hoist {
namespace {

TEST(OwnPointType, GivesWhatPointXYZRGBGives)
{
  const samples::Frame frame = samples::render(test::boxOnGround());
  for (const auto mode : {SegmentationMode::paper, SegmentationMode::full}) {
    CuboidSegmentation<TestPoint> own;
    CuboidSegmentation<pcl::PointXYZRGB> usual;
    own.setMode(mode);
    usual.setMode(mode);
    own.setInputCloud(test::convert<TestPoint>(frame.cloud));
    usual.setInputCloud(test::convert<pcl::PointXYZRGB>(frame.cloud));
    std::vector<Cuboid> first, second;
    ASSERT_TRUE(own.segment(first));
    ASSERT_TRUE(usual.segment(second));
    ASSERT_EQ(first.size(), second.size());
    ASSERT_FALSE(first.empty());
    EXPECT_EQ(first[0].center, second[0].center);
    EXPECT_EQ(first[0].size, second[0].size);
  }
}

TEST(OwnPointType, WorksInTheLineExtractionToo)
{
  const samples::Frame frame = samples::render(test::boxOnGround());
  LineSegmentExtraction<TestPoint> lines;
  lines.setInputCloud(test::convert<TestPoint>(frame.cloud));
  auto row = pcl::make_shared<pcl::Indices>();
  for (int u = 100; u < 500; ++u)
    row->push_back(450 * 640 + u);
  lines.setIndices(row);
  std::vector<LineSegment> segments;
  ASSERT_TRUE(lines.segment(segments));
  EXPECT_EQ(segments.size(), 1U);
}

} // namespace
} // namespace hoist
