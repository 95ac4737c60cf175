#include <hoist/filters/canny.h>

#include <opencv2/imgproc.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

namespace hoist {
namespace {

constexpr int edge_column = 160; // first bright column of edgeAndPrint()
const cv::Rect print_area(60, 40, 200, 160);

// 320 x 240, dark left and bright right, with rows of small random glyphs over the
// middle, on both sides of the edge and up to two pixels from it.
cv::Mat1b
edgeAndPrint(unsigned seed)
{
  cv::Mat1b image(240, 320, static_cast<unsigned char>(90));
  image.colRange(edge_column, 320) = 150;
  std::mt19937 random(seed);
  const auto next = [&](int n) { return static_cast<int>(random() % n); };
  for (int v = print_area.y; v + 7 < print_area.br().y; v += 8)
    for (int u = print_area.x; u + 6 < print_area.br().x; u += 7) {
      if (u < edge_column + 2 && u + 6 > edge_column - 2)
        continue;
      for (int stroke = 0; stroke < 3; ++stroke)
        cv::line(image,
                 {u + next(6), v + next(7)},
                 {u + next(6), v + next(7)},
                 u < edge_column ? 200 : 30);
    }
  return image;
}

cv::Mat1b
contours(const cv::Mat1b& image, const CannyParameters& parameters)
{
  Canny canny;
  canny.setImage(image, parameters.blur_sigma);
  cv::Mat1b edges;
  canny.detect(parameters, edges);
  return edges;
}

// Rows of the print area in which the long edge has a contour pixel.
int
rowsOnEdge(const cv::Mat1b& edges)
{
  int rows = 0;
  for (int v = print_area.y; v < print_area.br().y; ++v)
    rows += cv::countNonZero(edges(cv::Rect(edge_column - 2, v, 4, 1))) > 0 ? 1 : 0;
  return rows;
}

int
pixelsOfPrint(const cv::Mat1b& edges)
{
  cv::Mat1b print = edges(print_area).clone();
  print.colRange(edge_column - 3 - print_area.x, edge_column + 3 - print_area.x) = 0;
  return cv::countNonZero(print);
}

class CannyTexture : public ::testing::TestWithParam<unsigned> {};

TEST_P(CannyTexture, LongEdgeAcrossPrintStaysAndThePrintGoes)
{
  const cv::Mat1b image = edgeAndPrint(GetParam());
  CannyParameters parameters;
  parameters.edge_share = 0.2; // a fifth of this image is print
  parameters.remove_texture = false;
  const cv::Mat1b before = contours(image, parameters);
  parameters.remove_texture = true;
  const cv::Mat1b after = contours(image, parameters);
  ASSERT_GT(pixelsOfPrint(before), 2000);
  ASSERT_GT(rowsOnEdge(before), 0.9 * print_area.height);
  EXPECT_LT(pixelsOfPrint(after), 0.1 * pixelsOfPrint(before));
  EXPECT_GE(rowsOnEdge(after), 0.95 * rowsOnEdge(before));
  // outside the print nothing changes
  EXPECT_EQ(cv::countNonZero(after.rowRange(0, 20) != before.rowRange(0, 20)), 0);
  // removal only removes
  EXPECT_EQ(cv::countNonZero(after & ~before), 0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, CannyTexture, ::testing::Range(1U, 9U));

TEST(CannyTextureRemoval, LoneSmallShapesStay)
{
  cv::Mat1b image(240, 320, static_cast<unsigned char>(100));
  cv::circle(image, {80, 120}, 6, 200, cv::FILLED);
  cv::rectangle(image, {220, 110, 8, 8}, 200, cv::FILLED);
  CannyParameters parameters;
  parameters.texture_density = 0.25; // a circle of radius 6 fills a fifth of its window
  parameters.texture_window = 16;
  const cv::Mat1b with = contours(image, parameters);
  parameters.remove_texture = false;
  const cv::Mat1b without = contours(image, parameters);
  ASSERT_GT(cv::countNonZero(without), 40);
  EXPECT_EQ(cv::countNonZero(with != without), 0);
}

TEST(CannyThresholds, FollowTheContrast)
{
  // halving the contrast halves the gradients, so the contours stay
  const cv::Mat1b image = edgeAndPrint(3);
  cv::Mat1b half;
  image.convertTo(half, CV_8U, 0.5);
  Canny a, b;
  cv::Mat1b edges_a, edges_b;
  CannyParameters parameters;
  parameters.remove_texture = false;
  a.setImage(image);
  a.detect(parameters, edges_a);
  b.setImage(half);
  b.detect(parameters, edges_b);
  // bins of 1 grey level, and rounding in the image and the blur
  EXPECT_NEAR(b.getHighThreshold(), a.getHighThreshold() / 2, 4);
  EXPECT_NEAR(a.getLowThreshold(), parameters.low_ratio * a.getHighThreshold(), 1e-9);
  EXPECT_NEAR(cv::countNonZero(edges_b),
              cv::countNonZero(edges_a),
              0.05 * cv::countNonZero(edges_a));
}

TEST(CannyThresholds, LowerScaleFindsASuperset)
{
  const cv::Mat1b image = edgeAndPrint(5);
  CannyParameters parameters;
  parameters.remove_texture = false;
  cv::Mat1b fewer;
  for (const double scale : {2.0, 1.0, 0.5, 0.25}) {
    parameters.threshold_scale = scale;
    const cv::Mat1b more = contours(image, parameters);
    if (!fewer.empty()) {
      EXPECT_EQ(cv::countNonZero(fewer & ~more), 0) << "scale " << scale;
    }
    fewer = more;
  }
}

TEST(CannyThresholds, NoiseAloneGivesNoContours)
{
  cv::Mat1b image(240, 320);
  cv::RNG random(7);
  random.fill(image, cv::RNG::NORMAL, 128, 4);
  // magnitudes of normal noise are Rayleigh distributed: 6 medians are 7.06 sigmas,
  // which a sample passes with probability exp(-7.06^2 / 2) = 1.5e-11
  EXPECT_EQ(cv::countNonZero(contours(image, {})), 0);
}

TEST(CannyThresholds, FixedOnesAreTakenAsGiven)
{
  Canny canny;
  CannyParameters parameters;
  parameters.auto_threshold = false;
  parameters.low = 30;
  parameters.high = 90;
  parameters.threshold_scale = 0.5;
  cv::Mat1b edges;
  canny.setImage(edgeAndPrint(1));
  canny.detect(parameters, edges);
  EXPECT_EQ(canny.getLowThreshold(), 15);
  EXPECT_EQ(canny.getHighThreshold(), 45);
}

TEST(CannyBasics, BadParametersThrow)
{
  const cv::Mat1b image = edgeAndPrint(1);
  const auto detect = [&](auto change) {
    CannyParameters parameters;
    change(parameters);
    contours(image, parameters);
  };
  using P = CannyParameters;
  EXPECT_NO_THROW(detect([](P&) {}));
  EXPECT_THROW(detect([](P& p) { p.threshold_scale = 0; }), std::invalid_argument);
  EXPECT_THROW(detect([](P& p) { p.threshold_scale = NAN; }), std::invalid_argument);
  EXPECT_THROW(detect([](P& p) { p.edge_share = 1; }), std::invalid_argument);
  EXPECT_THROW(detect([](P& p) { p.low_ratio = 0; }), std::invalid_argument);
  EXPECT_THROW(detect([](P& p) { p.texture_density = 0; }), std::invalid_argument);
  EXPECT_THROW(detect([](P& p) { p.blur_sigma = -1; }), std::invalid_argument);
  EXPECT_THROW(detect([](P& p) {
                 p.auto_threshold = false;
                 p.low = 2 * p.high;
               }),
               std::invalid_argument);
}

TEST(CannyBasics, TinyImagesAndRepeatedCalls)
{
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(2, 1), cv::Size(3, 3)}) {
    cv::Mat1b image(size);
    cv::randu(image, 0, 255);
    const cv::Mat1b edges = contours(image, {});
    EXPECT_EQ(edges.size(), size);
  }
  Canny canny;
  cv::Mat1b edges(3, 3, static_cast<unsigned char>(9));
  canny.detect({}, edges); // no image
  EXPECT_TRUE(edges.empty());
  // a larger image in between leaves nothing behind
  const cv::Mat1b image = edgeAndPrint(2);
  cv::Mat1b first, second;
  canny.setImage(image);
  canny.detect({}, first);
  first = first.clone();
  canny.setImage(cv::Mat1b(480, 640, static_cast<unsigned char>(77)));
  canny.detect({}, second);
  EXPECT_EQ(cv::countNonZero(second), 0);
  canny.setImage(image);
  canny.detect({}, second);
  EXPECT_EQ(cv::countNonZero(first != second), 0);
}

} // namespace
} // namespace hoist
