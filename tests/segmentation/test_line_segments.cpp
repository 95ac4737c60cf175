// Straight segments of edge masks.
#include <hoist/segmentation/line_segments.h>

#include <opencv2/imgproc.hpp>

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

namespace hoist {
namespace {

cv::Mat1b
maskWithLine(cv::Point a, cv::Point b, cv::Size size = {320, 240})
{
  cv::Mat1b mask = cv::Mat1b::zeros(size);
  cv::line(mask, a, b, 255, 1, cv::LINE_8);
  return mask;
}

// Distance between the ends of two segments under the better order of the ends.
float
endDistance(const PixelSegment& s, const Eigen::Vector2f& a, const Eigen::Vector2f& b)
{
  return std::min(std::max((s.pixels[0] - a).norm(), (s.pixels[1] - b).norm()),
                  std::max((s.pixels[0] - b).norm(), (s.pixels[1] - a).norm()));
}

TEST(HoughSegments, FindTheLinesThatWereDrawn)
{
  std::mt19937 random(1);
  std::uniform_int_distribution<int> u(10, 309), v(10, 229);
  for (int seed = 0; seed < 50; ++seed) {
    const cv::Point a(u(random), v(random)), b(u(random), v(random));
    if (cv::norm(a - b) < 40)
      continue;
    std::vector<PixelSegment> segments;
    houghSegments(maskWithLine(a, b), {}, segments);
    mergeSegments(segments);
    ASSERT_EQ(segments.size(), 1U) << a << b;
    // The transform's angles are a quarter of a degree apart, so a long raster line may
    // leave the found one before its end. What is left there is found too unless it is
    // shorter than min_length.
    EXPECT_LT(endDistance(segments[0],
                          Eigen::Vector2f(static_cast<float>(a.x), a.y),
                          Eigen::Vector2f(static_cast<float>(b.x), b.y)),
              HoughParameters().min_length)
        << a << b;
  }
}

TEST(HoughSegments, EndsAreEdgePixels)
{
  const cv::Mat1b mask = maskWithLine({20, 30}, {280, 190});
  std::vector<PixelSegment> segments;
  houghSegments(mask, {}, segments);
  ASSERT_FALSE(segments.empty());
  for (const PixelSegment& s : segments)
    for (const auto& p : s.pixels)
      EXPECT_EQ(mask(cvRound(p.y()), cvRound(p.x())), 255);
}

TEST(HoughSegments, ShiftedMaskGivesShiftedSegments)
{
  cv::Mat1b mask = cv::Mat1b::zeros(240, 320), shifted = cv::Mat1b::zeros(480, 640);
  cv::rectangle(mask, {30, 40}, {200, 150}, 255);
  cv::line(mask, {40, 45}, {190, 140}, 255);
  const int du = 123, dv = 77;
  mask.copyTo(shifted(cv::Rect(du, dv, 320, 240)));
  std::vector<PixelSegment> first, second;
  houghSegments(mask, {}, first);
  houghSegments(shifted, {}, second);
  ASSERT_EQ(first.size(), second.size());
  ASSERT_FALSE(first.empty());
  for (std::size_t i = 0; i < first.size(); ++i)
    for (int k = 0; k < 2; ++k)
      EXPECT_EQ(first[i].pixels[k] + Eigen::Vector2f(du, dv), second[i].pixels[k]);
}

TEST(HoughSegments, EmptyMasksGiveNothingAndClearTheOutput)
{
  std::vector<PixelSegment> segments(3);
  houghSegments(cv::Mat1b(), {}, segments);
  EXPECT_TRUE(segments.empty());
  segments.resize(3);
  houghSegments(cv::Mat1b::zeros(10, 10), {}, segments);
  EXPECT_TRUE(segments.empty());
}

TEST(HoughSegments, RejectsNumbersOutOfRange)
{
  std::vector<PixelSegment> segments;
  HoughParameters p;
  p.rho = 0;
  EXPECT_THROW(houghSegments(cv::Mat1b::ones(9, 9), p, segments),
               std::invalid_argument);
  p = {};
  p.threshold = 0;
  EXPECT_THROW(houghSegments(cv::Mat1b::ones(9, 9), p, segments),
               std::invalid_argument);
}

PixelSegment
make(float u0, float v0, float u1, float v1)
{
  return {{Eigen::Vector2f(u0, v0), Eigen::Vector2f(u1, v1)}};
}

TEST(MergeSegments, JoinsPiecesOfOneEdge)
{
  std::vector<PixelSegment> pieces = {
      make(0, 0, 50, 0), make(100, 1, 53, 0), make(20, 1, 40, 1)};
  mergeSegments(pieces);
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_NEAR(pieces[0].length(), 100, 0.1);
}

TEST(MergeSegments, KeepsWhatIsNotOneEdge)
{
  const std::vector<PixelSegment> apart = {make(0, 0, 50, 0),  // an edge
                                           make(60, 0, 99, 0), // beyond the gap
                                           make(0, 5, 45, 5),  // beside it
                                           make(0, 0, 0, 40)}; // across it
  std::vector<PixelSegment> merged = apart;
  mergeSegments(merged);
  EXPECT_EQ(merged.size(), apart.size());
}

TEST(MergeSegments, DoesNotDependOnTheOrder)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<float> at(0, 100);
  std::vector<PixelSegment> all;
  for (int i = 0; i < 60; ++i) {
    const float u = at(random), v = std::round(at(random) / 10) * 10;
    all.push_back(make(u, v, u + at(random), v));
  }
  std::vector<PixelSegment> first = all;
  mergeSegments(first);
  EXPECT_LT(first.size(), all.size());
  for (int i = 0; i < 5; ++i) {
    std::shuffle(all.begin(), all.end(), random);
    std::vector<PixelSegment> again = all;
    mergeSegments(again);
    ASSERT_EQ(again.size(), first.size());
    for (std::size_t k = 0; k < first.size(); ++k)
      EXPECT_EQ(again[k].pixels, first[k].pixels);
  }
}

TEST(CollectSupport, IsTheDrawnLine)
{
  const cv::Mat1b mask = maskWithLine({20, 30}, {280, 190});
  const PixelSegment segment = make(20, 30, 280, 190);
  pcl::Indices support;
  collectSupport(mask, segment, 1, support);
  EXPECT_EQ(support.size(), static_cast<std::size_t>(cv::countNonZero(mask)));
  for (const int index : support)
    EXPECT_EQ(mask(index / mask.cols, index % mask.cols), 255);
}

TEST(CollectSupport, StaysInsideTheImage)
{
  const cv::Mat1b mask = cv::Mat1b(20, 20, 255);
  pcl::Indices support;
  collectSupport(mask, make(-5, 0, 30, 19), 2, support);
  ASSERT_FALSE(support.empty());
  for (const int index : support) {
    EXPECT_GE(index, 0);
    EXPECT_LT(index, 400);
  }
}

TEST(RefineSegment, FindsTheLineBelowThePixel)
{
  const cv::Mat1b mask = maskWithLine({20, 30}, {280, 190});
  PixelSegment segment = make(21, 31, 280, 188); // two pixels off at one end
  pcl::Indices support;
  collectSupport(mask, segment, 2, support);
  ASSERT_TRUE(refineSegment(support, mask.cols, segment));
  const Eigen::Vector2f direction = Eigen::Vector2f(260, 160).normalized();
  const Eigen::Vector2f normal(-direction.y(), direction.x());
  // rounding to pixels leaves 0.29 px rms per pixel, over 250 pixels 0.02 px
  for (const auto& p : segment.pixels)
    EXPECT_LT(std::abs(normal.dot(p - Eigen::Vector2f(20, 30))), 0.1F);
}

TEST(RefineSegment, LeavesASegmentWithoutSupportAlone)
{
  PixelSegment segment = make(1, 2, 3, 4);
  EXPECT_FALSE(refineSegment({5, 6}, 10, segment));
  EXPECT_EQ(segment.pixels, make(1, 2, 3, 4).pixels);
}

} // namespace
} // namespace hoist
