// Segmenters on whole frames, rendered and real: accuracy of the robust lines, equal
// bytes at any number of threads, real clouds without incident.
#include <hoist/data/load_frame.h>
#include <hoist/filters/edge_detector.h>
#include <hoist/segmentation/cuboid_segmentation.h>
#include <hoist/segmentation/extract_line_segments.h>

#include "scene_frames.h"

#include <support/real_data.h>

#include <opencv2/core/utility.hpp>

#include <gtest/gtest.h>

#include <algorithm>

namespace hoist {
namespace {

double
distanceToRun(const Eigen::Vector2d& p,
              const Eigen::Vector2d& a,
              const Eigen::Vector2d& b)
{
  const Eigen::Vector2d run = b - a;
  const double t = std::clamp((p - a).dot(run) / run.squaredNorm(), 0.0, 1.0);
  return (a + t * run - p).norm();
}

double
distanceToLine(const Eigen::Vector3d& p,
               const Eigen::Vector3d& a,
               const Eigen::Vector3d& b)
{
  return (p - a).cross((b - a).normalized()).norm();
}

struct Share {
  int on_edge = 0; // segments that lie on a projected edge of the box
  int right = 0;   // of them, those that are where the edge is in space
};

// Of the segments on the image of a box edge, how many lie on that edge in space,
// within what two pixels are there.
void
count(const std::vector<LineSegment>& segments,
      const Cuboid& box,
      const Intrinsics& camera,
      Share& share)
{
  const auto corners = box.corners();
  for (const LineSegment& s : segments) {
    bool on_edge = false, right = false;
    for (const auto& edge : Cuboid::edges()) {
      const Eigen::Vector3d a = corners.col(edge[0]), b = corners.col(edge[1]);
      const Eigen::Vector2d pa = camera.project(a), pb = camera.project(b);
      const auto at = [&](int k) {
        return distanceToRun(s.pixels[k].cast<double>(), pa, pb);
      };
      if (at(0) > 2 || at(1) > 2)
        continue;
      on_edge = true;
      const double pixel = std::max(a.z(), b.z()) / camera.fx;
      right = right || (distanceToLine(s.points[0], a, b) < 2 * pixel &&
                        distanceToLine(s.points[1], a, b) < 2 * pixel);
    }
    share.on_edge += on_edge ? 1 : 0;
    share.right += right ? 1 : 0;
  }
}

// Why there is a robust lift: the end pixels alone put a good part of the segments
// somewhere else.
TEST(LineLift, RobustSegmentsLieOnTheEdgesOfTheBox)
{
  Share paper, robust;
  EdgeDetector detector;
  for (std::uint64_t seed = 1; seed <= 15; ++seed) {
    samples::Scene scene = test::boxOnGround(seed);
    FrameImages images;
    toFrameImages(samples::render(scene).cloud, images);
    cv::Mat1b edges;
    detector.detect(images, {}, edges);
    for (const LineLift lift : {LineLift::endpoints, LineLift::robust}) {
      LineExtractionParameters parameters;
      parameters.lift = lift;
      std::vector<LineSegment> segments;
      Diagnostics diagnostics;
      extractLineSegments(images,
                          lift == LineLift::robust ? edges : detector.getContours(),
                          parameters,
                          segments,
                          diagnostics);
      count(segments,
            test::toCuboid(scene.boxes[0]),
            scene.camera,
            lift == LineLift::robust ? robust : paper);
    }
  }
  ASSERT_GT(robust.on_edge, 50);
  ASSERT_GT(paper.on_edge, 50);
  const double robust_share = static_cast<double>(robust.right) / robust.on_edge;
  const double paper_share = static_cast<double>(paper.right) / paper.on_edge;
  EXPECT_GT(robust_share, 0.8);
  EXPECT_GT(robust_share, paper_share + 0.1) << "paper " << paper_share;
}

TEST(CuboidSegmentation, GivesTheSameBytesAtAnyNumberOfThreads)
{
  const samples::Frame frame = samples::render(samples::randomTableScene(3, 5));
  const auto cloud = test::convert<pcl::PointXYZRGB>(frame.cloud);
  const int before = cv::getNumThreads();
  for (const auto mode : {SegmentationMode::paper, SegmentationMode::full}) {
    std::vector<Cuboid> first;
    for (const int threads : {1, 2, 7}) {
      cv::setNumThreads(threads);
      CuboidSegmentation<pcl::PointXYZRGB> segmentation;
      segmentation.setMode(mode);
      segmentation.setInputCloud(cloud);
      std::vector<Cuboid> cuboids;
      ASSERT_TRUE(segmentation.segment(cuboids));
      if (threads == 1)
        first = cuboids;
      ASSERT_EQ(cuboids.size(), first.size());
      for (std::size_t i = 0; i < first.size(); ++i) {
        EXPECT_EQ(cuboids[i].center, first[i].center);
        EXPECT_EQ(cuboids[i].axes, first[i].axes);
        EXPECT_EQ(cuboids[i].size, first[i].size);
        EXPECT_EQ(cuboids[i].score, first[i].score);
        EXPECT_EQ(cuboids[i].segments, first[i].segments);
      }
    }
  }
  cv::setNumThreads(before);
}

TEST(CuboidSegmentation, NamesTheSegmentsThatLieOnACuboid)
{
  CuboidSegmentation<pcl::PointXYZRGB> segmentation;
  const samples::Frame frame = samples::render(test::boxOnGround());
  segmentation.setInputCloud(test::convert<pcl::PointXYZRGB>(frame.cloud));
  std::vector<Cuboid> with, without;
  ASSERT_TRUE(segmentation.segment(with));
  ASSERT_EQ(with.size(), 1U);
  EXPECT_GE(with[0].segments.size(), 3U);
  EXPECT_FALSE(segmentation.getEdgePixels().empty());
  segmentation.setReportLines(false);
  ASSERT_TRUE(segmentation.segment(without));
  ASSERT_EQ(without.size(), 1U);
  EXPECT_TRUE(segmentation.getSegments().empty());
  EXPECT_TRUE(segmentation.getEdgePixels().empty());
  // the report changes nothing else
  EXPECT_EQ(with[0].center, without[0].center);
  EXPECT_EQ(with[0].score, without[0].score);
}

// Invariants of Cuboid hold whatever a real sensor delivers.
TEST(CuboidSegmentation, RealFramesGiveProperCuboids)
{
  HOIST_SKIP_WITHOUT_REAL_DATA();
  const auto folder = *test::realData() / "mosd" / "scenes";
  for (const char* scene : {"learn0.pcd", "learn20.pcd", "test0.pcd"}) {
    const LoadedFrame frame = loadFrame((folder / scene).string());
    for (const auto mode : {SegmentationMode::paper, SegmentationMode::full}) {
      CuboidSegmentation<pcl::PointXYZRGB> segmentation;
      segmentation.setMode(mode);
      segmentation.setInputCloud(frame.cloud);
      std::vector<Cuboid> cuboids;
      ASSERT_TRUE(segmentation.segment(cuboids)) << scene;
      EXPECT_FALSE(segmentation.getDiagnostics().counts.entries().empty());
      for (const Cuboid& c : cuboids) {
        EXPECT_NEAR(c.axes.determinant(), 1, 1e-9);
        EXPECT_LT((c.axes.transpose() * c.axes - Eigen::Matrix3d::Identity()).norm(),
                  1e-9);
        EXPECT_GT(c.size.minCoeff(), 0);
        EXPECT_GE(c.score, 0);
        EXPECT_LE(c.score, 1);
        for (const int i : c.indices) {
          EXPECT_GE(i, 0);
          EXPECT_LT(i, static_cast<int>(frame.cloud->size()));
        }
      }
    }
  }
}

} // namespace
} // namespace hoist
