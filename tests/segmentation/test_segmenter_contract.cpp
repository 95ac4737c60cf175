// What every segmenter promises, for every point type: outputs are cleared first, a
// failure leaves them empty, a second call equals the first, indices are obeyed.
#include <hoist/data/point_types.h>
#include <hoist/segmentation/cuboid_segmentation.h>
#include <hoist/segmentation/line_segment_extraction.h>

#include "scene_frames.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace hoist {
namespace {

// How the contract drives a stage: outputs reduced to numbers that can be compared.
template <typename PointT>
struct Lines {
  using Point = PointT;
  using Stage = LineSegmentExtraction<PointT>;
  static constexpr bool needs_color = false;
  static constexpr bool needs_indices = true;

  static bool
  run(Stage& stage, std::vector<double>& out)
  {
    std::vector<LineSegment> segments(3); // left over from another call
    const bool done = stage.segment(segments);
    out.clear();
    for (const LineSegment& s : segments) {
      for (const auto& p : s.points)
        out.insert(out.end(), p.data(), p.data() + 3);
      out.insert(out.end(), s.indices.begin(), s.indices.end());
    }
    return done;
  }
};

template <typename PointT, SegmentationMode mode>
struct Cuboids {
  using Point = PointT;
  struct Stage : CuboidSegmentation<PointT> {
    Stage() { this->setMode(mode); }
  };
  static constexpr bool needs_color = mode == SegmentationMode::paper;
  static constexpr bool needs_indices = false;

  static bool
  run(Stage& stage, std::vector<double>& out)
  {
    std::vector<Cuboid> cuboids(3); // left over from another call
    const bool done = stage.segment(cuboids);
    out.clear();
    for (const Cuboid& c : cuboids) {
      out.insert(out.end(), c.center.data(), c.center.data() + 3);
      out.insert(out.end(), c.axes.data(), c.axes.data() + 9);
      out.insert(out.end(), c.size.data(), c.size.data() + 3);
      out.push_back(c.score);
      for (const int i : c.segments)
        EXPECT_LT(i, static_cast<int>(stage.getSegments().size()));
      for (const int i : c.vertices)
        EXPECT_LT(i, static_cast<int>(stage.getVertices().size()));
    }
    return done;
  }
};

template <typename PointT>
using PaperCuboids = Cuboids<PointT, SegmentationMode::paper>;
template <typename PointT>
using FullCuboids = Cuboids<PointT, SegmentationMode::full>;

template <typename Case>
class SegmenterContract : public testing::Test {
protected:
  using Point = typename Case::Point;
  using Cloud = pcl::PointCloud<Point>;
  using Stage = typename Case::Stage;

  static constexpr bool has_gray =
      pcl::traits::has_color<Point>::value || pcl::traits::has_intensity<Point>::value;
  static constexpr bool usable = has_gray || !Case::needs_color;

  static const samples::Frame&
  frame()
  {
    static const samples::Frame rendered = samples::render(test::boxOnGround());
    return rendered;
  }

  static typename Cloud::Ptr
  cloud()
  {
    return test::convert<Point>(frame().cloud);
  }

  // Pixels beside which something else is seen: the edges of the truth.
  static pcl::IndicesPtr
  edges()
  {
    const auto& object = frame().truth.object;
    const auto& face = frame().truth.face;
    auto out = pcl::make_shared<pcl::Indices>();
    for (int v = 0; v + 1 < object.rows; ++v)
      for (int u = 0; u + 1 < object.cols; ++u)
        if (object(v, u) != object(v, u + 1) || object(v, u) != object(v + 1, u) ||
            face(v, u) != face(v, u + 1) || face(v, u) != face(v + 1, u))
          out->push_back(v * object.cols + u);
    return out;
  }

  static void
  prepare(Stage& stage, const typename Cloud::ConstPtr& cloud)
  {
    stage.setInputCloud(cloud);
    if (Case::needs_indices)
      stage.setIndices(edges());
  }
};

using Cases = testing::Types<Lines<pcl::PointXYZ>,
                             Lines<pcl::PointXYZI>,
                             Lines<pcl::PointXYZRGB>,
                             Lines<pcl::PointXYZRGBA>,
                             Lines<pcl::PointXYZRGBL>,
                             Lines<hoist::PointXYZRGBUV>,
                             PaperCuboids<pcl::PointXYZ>,
                             PaperCuboids<pcl::PointXYZI>,
                             PaperCuboids<pcl::PointXYZRGB>,
                             PaperCuboids<pcl::PointXYZRGBA>,
                             PaperCuboids<pcl::PointXYZRGBL>,
                             PaperCuboids<hoist::PointXYZRGBUV>,
                             FullCuboids<pcl::PointXYZ>,
                             FullCuboids<pcl::PointXYZI>,
                             FullCuboids<pcl::PointXYZRGB>,
                             FullCuboids<pcl::PointXYZRGBA>,
                             FullCuboids<pcl::PointXYZRGBL>,
                             FullCuboids<hoist::PointXYZRGBUV>>;
TYPED_TEST_SUITE(SegmenterContract, Cases);

TYPED_TEST(SegmenterContract, FindsSomethingAndTheSameAgain)
{
  typename TestFixture::Stage stage;
  this->prepare(stage, this->cloud());
  std::vector<double> first, second;
  const bool done = TypeParam::run(stage, first);
  EXPECT_EQ(done, TestFixture::usable);
  EXPECT_EQ(!first.empty(), TestFixture::usable);
  EXPECT_EQ(TypeParam::run(stage, second), done);
  EXPECT_EQ(first, second);
  typename TestFixture::Stage fresh;
  this->prepare(fresh, this->cloud());
  TypeParam::run(fresh, second);
  EXPECT_EQ(first, second);
}

TYPED_TEST(SegmenterContract, WithoutInputItFailsAndClears)
{
  typename TestFixture::Stage stage;
  std::vector<double> out;
  EXPECT_FALSE(TypeParam::run(stage, out));
  EXPECT_TRUE(out.empty());
  EXPECT_TRUE(stage.getDiagnostics().counts.entries().empty());
}

TYPED_TEST(SegmenterContract, FramesWithoutPointsGiveNothing)
{
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  typename TestFixture::Point hole;
  hole.x = hole.y = hole.z = nan;
  typename TestFixture::Point point;
  point.x = point.y = 0;
  point.z = 1;
  const std::vector<typename TestFixture::Cloud> clouds = {
      typename TestFixture::Cloud(),            // empty
      typename TestFixture::Cloud(1, 1, point), // one point: not organized
      typename TestFixture::Cloud(64, 48, hole)};
  for (const auto& cloud : clouds) {
    typename TestFixture::Stage stage;
    stage.setInputCloud(pcl::make_shared<typename TestFixture::Cloud>(cloud));
    auto all = pcl::make_shared<pcl::Indices>(cloud.size());
    std::iota(all->begin(), all->end(), 0);
    stage.setIndices(all);
    std::vector<double> out;
    const bool done = TypeParam::run(stage, out);
    EXPECT_TRUE(out.empty());
    EXPECT_TRUE(!done || cloud.height > 1);
  }
}

TYPED_TEST(SegmenterContract, AFailureAfterASuccessLeavesNothingBehind)
{
  typename TestFixture::Stage stage;
  this->prepare(stage, this->cloud());
  std::vector<double> out;
  TypeParam::run(stage, out);
  auto flat = this->cloud();
  flat->width = static_cast<std::uint32_t>(flat->size());
  flat->height = 1;
  stage.setInputCloud(flat);
  EXPECT_FALSE(TypeParam::run(stage, out));
  EXPECT_TRUE(out.empty());
  EXPECT_TRUE(stage.getDiagnostics().counts.entries().empty());
}

TYPED_TEST(SegmenterContract, IndicesOutsideTheCloudAreRefused)
{
  for (const int wrong : {-1, 640 * 480}) {
    typename TestFixture::Stage stage;
    stage.setInputCloud(this->cloud());
    auto indices = this->edges();
    indices->push_back(wrong);
    stage.setIndices(indices);
    std::vector<double> out;
    EXPECT_FALSE(TypeParam::run(stage, out));
    EXPECT_TRUE(out.empty());
  }
}

TYPED_TEST(SegmenterContract, NoIndicesGivenMeansNoPixels)
{
  typename TestFixture::Stage stage;
  stage.setInputCloud(this->cloud());
  stage.setIndices(pcl::make_shared<pcl::Indices>());
  std::vector<double> out;
  TypeParam::run(stage, out);
  EXPECT_TRUE(out.empty());
}

TYPED_TEST(SegmenterContract, SharedImagesGiveWhatTheCloudGives)
{
  typename TestFixture::Stage stage;
  const auto cloud = this->cloud();
  this->prepare(stage, cloud);
  std::vector<double> own, shared;
  TypeParam::run(stage, own);
  auto images = pcl::make_shared<FrameImages>();
  toFrameImages(*cloud, *images);
  stage.setFrameImages(images);
  EXPECT_EQ(stage.getFrameImages(), images);
  TypeParam::run(stage, shared);
  EXPECT_EQ(own, shared);

  auto other = pcl::make_shared<FrameImages>();
  toFrameImages(typename TestFixture::Cloud(32, 24), *other);
  stage.setFrameImages(other);
  EXPECT_FALSE(TypeParam::run(stage, shared));
  EXPECT_TRUE(shared.empty());
  stage.setInputCloud(cloud); // forgets them
  EXPECT_EQ(stage.getFrameImages(), nullptr);
  TypeParam::run(stage, shared);
  EXPECT_EQ(own, shared);
}

TYPED_TEST(SegmenterContract, TheInputIsNotTouched)
{
  typename TestFixture::Stage stage;
  const auto cloud = this->cloud();
  const auto indices = this->edges();
  const pcl::Indices before = *indices;
  stage.setInputCloud(cloud);
  stage.setIndices(indices);
  std::vector<double> out;
  TypeParam::run(stage, out);
  EXPECT_EQ(*indices, before);
  const auto same = this->cloud();
  for (std::size_t i = 0; i < cloud->size(); ++i)
    ASSERT_TRUE(
        ((*cloud)[i].getVector3fMap().array() == (*same)[i].getVector3fMap().array())
            .all() ||
        !std::isfinite((*same)[i].z));
}

// A detector's box around the object is enough, one beside it finds nothing.
TEST(CuboidSegmentation, IndicesAreTheDetectorsBox)
{
  const samples::Scene scene = test::boxOnGround();
  const samples::Frame frame = samples::render(scene);
  const auto cloud = test::convert<pcl::PointXYZRGB>(frame.cloud);
  cv::Rect box;
  for (int v = 0, first = 1; v < 480; ++v)
    for (int u = 0; u < 640; ++u)
      if (frame.truth.object(v, u) == 0) {
        box = first != 0 ? cv::Rect(u, v, 1, 1) : box | cv::Rect(u, v, 1, 1);
        first = 0;
      }
  for (const auto mode : {SegmentationMode::paper, SegmentationMode::full}) {
    CuboidSegmentation<pcl::PointXYZRGB> stage;
    EXPECT_EQ(stage.getMode(), SegmentationMode::full);
    stage.setMode(mode);
    stage.setInputCloud(cloud);
    const int margin = 6;
    stage.setIndices(box.y - margin,
                     box.x - margin,
                     box.height + 2 * margin,
                     box.width + 2 * margin);
    std::vector<Cuboid> cuboids;
    ASSERT_TRUE(stage.segment(cuboids));
    ASSERT_FALSE(cuboids.empty()) << toString(CuboidModel::vertex_one);
    for (const int i : stage.getEdgePixels()) {
      EXPECT_GE(i % 640, box.x - margin);
      EXPECT_LT(i % 640, box.br().x + margin);
    }
    stage.setIndices(0, 0, 40, 40);
    ASSERT_TRUE(stage.segment(cuboids));
    EXPECT_TRUE(cuboids.empty());
  }
}

TEST(CuboidSegmentation, SaysWhatEveryStageDid)
{
  CuboidSegmentation<pcl::PointXYZRGB> stage;
  stage.setMode(SegmentationMode::paper);
  const samples::Frame frame = samples::render(test::boxOnGround());
  stage.setInputCloud(test::convert<pcl::PointXYZRGB>(frame.cloud));
  std::vector<Cuboid> cuboids;
  ASSERT_TRUE(stage.segment(cuboids));
  const Tally& counts = stage.getDiagnostics().counts;
  EXPECT_EQ(counts["edge pixels"], stage.getEdgePixels().size());
  EXPECT_EQ(counts["line segments"], stage.getSegments().size());
  EXPECT_EQ(counts["vertices"], stage.getVertices().size());
  EXPECT_EQ(counts["cuboids"], cuboids.size());
  EXPECT_GE(counts["rounds"], 1U);
  // every hypothesis became a cuboid or has its reason
  const Tally& rejected = stage.getDiagnostics().rejected;
  EXPECT_EQ(counts["hypotheses"],
            cuboids.size() + rejected["model I: not perpendicular"] +
                rejected["model II: not perpendicular"] +
                rejected["same box, lower score"]);
  EXPECT_EQ(counts["image segments"],
            counts["line segments"] + rejected["segment without depth"]);
}

} // namespace
} // namespace hoist
