#include <hoist/recognition/region_ops.h>

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace hoist {
namespace {

using Numbers = std::vector<float>;

// What torchvision said; fixtures/make_region_ops.py made it.
const Numbers&
torchvision(const std::string& name)
{
  static const std::map<std::string, Numbers> all = [] {
    std::map<std::string, Numbers> read;
    std::ifstream in(std::string(HOIST_FIXTURES) + "/region_ops.txt");
    std::string key;
    for (std::size_t count = 0; in >> key >> count;) {
      Numbers& numbers = read[key];
      numbers.resize(count);
      for (float& number : numbers)
        in >> number;
    }
    return read;
  }();
  return all.at(name);
}

std::vector<Corners>
fours(const Numbers& numbers)
{
  std::vector<Corners> list;
  for (std::size_t i = 0; i + 3 < numbers.size(); i += 4)
    list.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 3]);
  return list;
}

cv::Mat
mapOf(int channels, int height, int width)
{
  const int shape[] = {1, channels, height, width};
  return cv::Mat(4, shape, CV_32F);
}

TEST(RoiAlign, IsTorchvisions)
{
  cv::Mat features = mapOf(3, 12, 16);
  const Numbers& values = torchvision("features");
  ASSERT_EQ(values.size(), features.total());
  std::copy(values.begin(), values.end(), features.ptr<float>());
  const Numbers& expected = torchvision("pooled");
  cv::Mat pooled;
  roiAlign(features, fours(torchvision("regions")), 1.0 / 8, 3, 2, pooled);
  ASSERT_EQ(pooled.total(), expected.size());
  ASSERT_GT(expected.size(), 400u);
  for (std::size_t i = 0; i < expected.size(); ++i)
    // places of up to 25 pixels round to 2e-6 of a pixel, and slopes are below 5
    ASSERT_NEAR(pooled.ptr<float>()[i], expected[i], 2e-5) << i;
}

TEST(RoiAlign, OfAConstantIsTheConstantInside)
{
  cv::Mat features = mapOf(2, 9, 7), pooled;
  features.setTo(3.5f);
  roiAlign(features, {{1, 2, 6, 8}, {0, 0, 7, 9}}, 1, 7, 2, pooled);
  for (std::size_t i = 0; i < pooled.total(); ++i)
    EXPECT_NEAR(pooled.ptr<float>()[i], 3.5f, 1e-5); // rounding of the four weights
}

TEST(RoiAlign, OfALinearMapIsItsValueAtTheCellsCentre)
{
  cv::Mat features = mapOf(1, 20, 30), pooled;
  for (int v = 0; v < 20; ++v)
    for (int u = 0; u < 30; ++u)
      features.ptr<float>()[v * 30 + u] = 2.f * u - 3.f * v;
  const Corners region(8, 12, 50, 33); // at scale 0.5: 4, 6 to 25, 16.5
  roiAlign(features, {region}, 0.5, 7, 2, pooled);
  for (int v = 0; v < 7; ++v)
    for (int u = 0; u < 7; ++u)
      EXPECT_NEAR(pooled.ptr<float>()[v * 7 + u],
                  2 * (4 + (u + 0.5) * 3) - 3 * (6 + (v + 0.5) * 1.5),
                  1e-4); // values of up to 60 in float
}

TEST(RoiAlign, WrongInputIsRefusedAndNoRegionsAreNone)
{
  cv::Mat pooled = mapOf(1, 2, 2);
  const cv::Mat features = cv::Mat::zeros(4, mapOf(1, 4, 4).size.p, CV_32F);
  roiAlign(features, {}, 1, 7, 2, pooled);
  EXPECT_TRUE(pooled.empty());
  const std::vector<Corners> one = {{0, 0, 1, 1}};
  EXPECT_THROW(roiAlign(cv::Mat(), one, 1, 7, 2, pooled), std::invalid_argument);
  EXPECT_THROW(roiAlign(features, one, 0, 7, 2, pooled), std::invalid_argument);
  EXPECT_THROW(roiAlign(features, one, 1, 0, 2, pooled), std::invalid_argument);
}

TEST(DecodeBox, IsTorchvisions)
{
  const auto anchors = fours(torchvision("anchors"));
  const auto deltas = fours(torchvision("deltas"));
  const auto expected = fours(torchvision("decoded"));
  ASSERT_EQ(expected.size(), 12u);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const Corners box = decodeBox(anchors[i], deltas[i], {10, 10, 5, 5});
    for (int k = 0; k < 4; ++k) // float's rounding, of boxes of up to 4000 px
      EXPECT_NEAR(box[k], expected[i][k], 1e-6 * std::max(1000.f, std::abs(box[k])));
  }
}

TEST(DecodeBox, NoDeltaIsTheAnchor)
{
  EXPECT_EQ(decodeBox({2, 4, 10, 20}, {0, 0, 0, 0}, {1, 1, 1, 1}),
            Corners(2, 4, 10, 20));
}

TEST(SuppressOverlaps, IsTorchvisions)
{
  const Numbers& expected = torchvision("kept");
  const std::vector<int> kept =
      suppressOverlaps(fours(torchvision("boxes")), torchvision("scores"), 0.4);
  EXPECT_EQ(Numbers(kept.begin(), kept.end()), expected);
  EXPECT_GT(expected.size(), 5u);
  EXPECT_LT(expected.size(), 75u);
}

TEST(SuppressOverlaps, OfEqualScoresTheFirstStays)
{
  const std::vector<Corners> boxes = {{0, 0, 4, 4}, {0, 0, 4, 4}, {9, 9, 12, 12}};
  EXPECT_EQ(suppressOverlaps(boxes, {0.5f, 0.5f, 0.5f}, 0.5), (std::vector<int>{0, 2}));
  EXPECT_THROW(suppressOverlaps(boxes, {1.f}, 0.5), std::invalid_argument);
}

} // namespace
} // namespace hoist
