#include "filters/contract_frame.h"

#include <hoist/filters/color_gains.h>
#include <hoist/filters/edge_pixels.h>
#include <hoist/filters/organize_by_pixel.h>
#include <hoist/filters/polygon_mask.h>
#include <hoist/filters/region_crop.h>
#include <hoist/filters/white_balance.h>

#include <pcl/exceptions.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace hoist {
namespace {

using test::contractFrame;
using test::not_a_number;

// Random colours whose mean is grey and whose brightest values are white.
cv::Mat3b
balancedImage()
{
  cv::Mat3b image(100, 100);
  std::mt19937 random(4);
  for (auto& p : image) {
    const auto next = [&] { return static_cast<unsigned char>(30 + random() % 100); };
    p = {next(), next(), next()};
  }
  return image;
}

class KnownLight : public ::testing::TestWithParam<WhiteBalanceMethod> {};

TEST_P(KnownLight, IsRecovered)
{
  WhiteBalanceParameters parameters;
  parameters.method = GetParam();
  cv::Mat3b image = balancedImage();
  const cv::Mat3b truth = image.clone();
  ColorGains light;
  light.r = 1.4;
  light.g = 1.0;
  light.b = 0.7;
  applyGains(light, image);
  const ColorGains gains = estimateGains(image, cv::Mat1b(), parameters);
  ASSERT_TRUE(gains.valid);
  // 10^4 samples of 30 ... 129: the mean is good to 0.3, the percentile to 0.3 levels
  EXPECT_NEAR(gains.r * light.r / (gains.g * light.g), 1, 0.01);
  EXPECT_NEAR(gains.b * light.b / (gains.g * light.g), 1, 0.01);
  // and the image comes back, up to the brightness, within the rounding of two tables
  applyGains(gains, image);
  double most = 0;
  for (int i = 0; i < static_cast<int>(image.total()); ++i)
    for (int c = 0; c < 3; ++c)
      most = std::max(most, std::abs(image(i)[c] - gains.g * light.g * truth(i)[c]));
  EXPECT_LE(most, 3.5);
}

TEST_P(KnownLight, ABalancedImageStays)
{
  WhiteBalanceParameters parameters;
  parameters.method = GetParam();
  const ColorGains gains = estimateGains(balancedImage(), cv::Mat1b(), parameters);
  EXPECT_NEAR(gains.r, 1, 0.01);
  EXPECT_NEAR(gains.g, 1, 0.01);
  EXPECT_NEAR(gains.b, 1, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Methods,
                         KnownLight,
                         ::testing::Values(WhiteBalanceMethod::grey_world,
                                           WhiteBalanceMethod::white_patch));

TEST(WhiteBalanceValues, ClippedAndDarkPixelsDoNotCount)
{
  cv::Mat3b image = balancedImage();
  const ColorGains expected = estimateGains(image);
  cv::Mat3b more(140, 100);
  image.copyTo(more.rowRange(0, 100));
  more.rowRange(100, 120) = cv::Vec3b(255, 200, 120); // a clipped lamp
  more.rowRange(120, 140) = cv::Vec3b(2, 40, 9);      // a shadow
  const ColorGains gains = estimateGains(more);
  EXPECT_EQ(gains.r, expected.r);
  EXPECT_EQ(gains.b, expected.b);
  // nothing left: no gains, and it says so
  const ColorGains none = estimateGains(more.rowRange(100, 140).clone());
  EXPECT_FALSE(none.valid);
  EXPECT_EQ(none.r, 1);
}

TEST(WhiteBalanceValues, TheMaskAndTheIndicesChooseWhoTells)
{
  cv::Mat3b image(10, 10, cv::Vec3b(60, 90, 120));
  image.rowRange(0, 5) = cv::Vec3b(100, 100, 100);
  cv::Mat1b mask(10, 10, static_cast<unsigned char>(0));
  mask.rowRange(0, 5) = 1;
  EXPECT_NEAR(estimateGains(image, mask).r, 1, 1e-9);
  mask = 1 - mask;
  // a channel's value of 60, 90 or 120 in all pixels: quantiles are exact to one bin
  EXPECT_NEAR(estimateGains(image, mask).b / estimateGains(image, mask).r, 2, 0.02);

  auto cloud = contractFrame<pcl::PointXYZRGB>();
  WhiteBalance<pcl::PointXYZRGB> filter;
  filter.setMethod(WhiteBalanceMethod::grey_world);
  filter.setInputCloud(cloud);
  auto first = pcl::make_shared<pcl::Indices>(pcl::Indices{0, 1, 2});
  filter.setIndices(first);
  pcl::PointCloud<pcl::PointXYZRGB> output;
  filter.filter(output);
  ASSERT_TRUE(filter.getGains().valid);
  ASSERT_EQ(output.size(), cloud->size()) << "all points stay";
  double mean_r = 0, mean_b = 0;
  for (const auto i : *first) {
    mean_r += (*cloud)[i].r;
    mean_b += (*cloud)[i].b;
  }
  EXPECT_NEAR(filter.getGains().b / filter.getGains().r, mean_r / mean_b, 1e-9);
  for (std::size_t i = 0; i < output.size(); ++i)
    ASSERT_EQ(output[i].r, std::round((*cloud)[i].r * filter.getGains().r));
}

TEST(WhiteBalanceValues, LightsArePlausibleAndPaintsAreNot)
{
  // the white points of sRGB (D65), of D50 and of illuminant A in sRGB's coding
  EXPECT_LT(tintOfLight({255, 255, 255}), 0.006);
  EXPECT_LT(tintOfLight({255, 235, 206}), 0.01);
  EXPECT_LT(tintOfLight({255, 178, 100}), 0.01);
  for (const std::array<double, 3>& paint :
       {std::array<double, 3>{200, 30, 45}, {60, 200, 70}, {190, 60, 190}})
    EXPECT_GT(tintOfLight(paint), 0.05) << paint[0] << ' ' << paint[1];
  // brightness is no matter of it but for the foot of sRGB's curve
  EXPECT_NEAR(tintOfLight({200, 150, 100}), tintOfLight({100, 75, 50}), 0.003);
}

// A red carton that fills the frame is no red lamp: it must not turn grey.
TEST(WhiteBalanceValues, WhatFillsTheFrameIsNoLight)
{
  const cv::Mat3b image(20, 20, cv::Vec3b(45, 30, 200));
  const ColorGains gains = estimateGains(image);
  EXPECT_FALSE(gains.valid);
  EXPECT_EQ(gains.r, 1);
  EXPECT_EQ(gains.b, 1);
  WhiteBalanceParameters parameters;
  parameters.max_tint = 10; // whoever knows better may say so
  EXPECT_TRUE(estimateGains(image, cv::Mat1b(), parameters).valid);
  parameters.max_tint = -1;
  EXPECT_THROW(estimateGains(image, cv::Mat1b(), parameters), std::invalid_argument);
}

TEST(WhiteBalanceValues, AClippedWhiteStaysWhite)
{
  cv::Mat3b image(20, 20, cv::Vec3b(140, 180, 200)); // a warm lamp on white
  image.row(0) = cv::Vec3b(255, 255, 255);
  const ColorGains gains = estimateGains(image);
  ASSERT_TRUE(gains.valid);
  EXPECT_GT(gains.b, 1.2);
  applyGains(gains, image);
  EXPECT_EQ(image(0, 0), cv::Vec3b(255, 255, 255));
}

TEST(WhiteBalanceValues, BadParametersThrow)
{
  WhiteBalanceParameters parameters;
  parameters.percentile = 0;
  EXPECT_THROW(estimateGains(balancedImage(), cv::Mat1b(), parameters),
               std::invalid_argument);
  WhiteBalance<pcl::PointXYZRGB> filter;
  EXPECT_THROW(filter.setPercentile(101), pcl::BadArgumentException);
  filter.setParameters(parameters);
  filter.setInputCloud(contractFrame<pcl::PointXYZRGB>());
  pcl::PointCloud<pcl::PointXYZRGB> output;
  EXPECT_THROW(filter.filter(output), pcl::BadArgumentException);
}

PointXYZRGBUV
record(float z, std::uint32_t u, std::uint32_t v, std::uint8_t red)
{
  PointXYZRGBUV p;
  p.x = 0.1F * z;
  p.y = 0.2F * z;
  p.z = z;
  p.r = red;
  p.u = u;
  p.v = v;
  return p;
}

TEST(OrganizeByPixelValues, TheNearestOfAPixelStays)
{
  auto records = pcl::make_shared<pcl::PointCloud<PointXYZRGBUV>>();
  records->push_back(record(2.0F, 3, 1, 10));         // 0 farther
  records->push_back(record(1.0F, 3, 1, 20));         // 1 nearest
  records->push_back(record(1.0F, 3, 1, 30));         // 2 equal, later
  records->push_back(record(0.0F, 0, 0, 40));         // 3 not measured, but coloured
  records->push_back(record(not_a_number, 0, 0, 50)); // 4
  records->push_back(record(-1.0F, 1, 2, 60));        // 5 behind the camera
  records->push_back(record(3.0F, 1, 2, 70)); // 6 measured, after one that is not
  OrganizeByPixel<PointXYZRGBUV> filter(true);
  filter.setInputCloud(records);
  pcl::PointCloud<PointXYZRGBUV> out;
  filter.filter(out);
  ASSERT_EQ(out.width, 4U);
  ASSERT_EQ(out.height, 3U);
  EXPECT_FALSE(out.is_dense);
  EXPECT_EQ(out(3, 1).z, 1.0F);
  EXPECT_EQ(out(3, 1).r, 20);
  EXPECT_TRUE(std::isnan(out(0, 0).z));
  EXPECT_EQ(out(0, 0).r, 40) << "the colour of the first record";
  EXPECT_EQ(out(1, 2).z, 3.0F);
  EXPECT_EQ(out(1, 2).r, 70);
  EXPECT_TRUE(std::isnan(out(2, 2).x));
  EXPECT_EQ(out(2, 2).r, 0);
  for (std::uint32_t v = 0; v < out.height; ++v)
    for (std::uint32_t u = 0; u < out.width; ++u) {
      EXPECT_EQ(out(u, v).u, u);
      EXPECT_EQ(out(u, v).v, v);
    }
  EXPECT_EQ(*filter.getRemovedIndices(), (pcl::Indices{0, 2, 3, 4, 5}));
}

TEST(OrganizeByPixelValues, ASizeCutsAndCounts)
{
  auto records = pcl::make_shared<pcl::PointCloud<PointXYZRGBUV>>();
  records->push_back(record(1.0F, 9, 9, 1));
  records->push_back(record(1.0F, 10, 9, 2));
  records->push_back(record(1.0F, 9, 10, 3));
  records->push_back(record(1.0F, 4294967295U, 4294967295U, 4));
  OrganizeByPixel<PointXYZRGBUV> filter;
  filter.setInputCloud(records);
  filter.setSize(10, 10);
  pcl::PointCloud<PointXYZRGBUV> out;
  filter.filter(out);
  EXPECT_EQ(out.width, 10U);
  EXPECT_EQ(out.height, 10U);
  EXPECT_EQ(out(9, 9).r, 1);
  EXPECT_EQ(filter.getOutsideCount(), 3U);
  // without a size that last record would need 2^64 pixels
  filter.setSize(0, 0);
  EXPECT_THROW(filter.filter(out), pcl::BadArgumentException);
  EXPECT_TRUE(out.empty());
  EXPECT_THROW(filter.setSize(0, 10), pcl::BadArgumentException);
}

TEST(OrganizeByPixelValues, ShuffledRecordsOfAFrameGiveTheFrame)
{
  const auto frame = contractFrame<PointXYZRGBUV>();
  auto records = pcl::make_shared<pcl::PointCloud<PointXYZRGBUV>>(*frame);
  std::mt19937 random(1);
  for (std::size_t i = records->size() - 1; i > 0; --i)
    std::swap((*records)[i], (*records)[random() % (i + 1)]);
  records->width = static_cast<std::uint32_t>(records->size());
  records->height = 1;
  OrganizeByPixel<PointXYZRGBUV> filter;
  filter.setInputCloud(records);
  pcl::PointCloud<PointXYZRGBUV> out;
  filter.filter(out);
  ASSERT_EQ(out.width, frame->width);
  for (std::size_t i = 0; i < out.size(); ++i) {
    EXPECT_EQ(out[i].rgba, (*frame)[i].rgba);
    EXPECT_EQ(std::isnan(out[i].z), std::isnan((*frame)[i].z));
    if (!std::isnan(out[i].z)) {
      EXPECT_EQ(out[i].x, (*frame)[i].x);
    }
  }
}

TEST(RegionCropValues, TheBoxIsHalfOpenAndMayReachOverTheBorder)
{
  const auto frame = contractFrame<pcl::PointXYZ>();
  RegionCrop<pcl::PointXYZ> filter;
  filter.setInputCloud(frame);
  pcl::Indices indices;
  filter.setBox({-5, -5, 8, 7.5}); // u < 3, v < 2.5
  filter.filter(indices);
  EXPECT_EQ(cv::countNonZero(filter.getRegionImage()), 3 * 3);
  filter.setBox({100, 100, 5, 5});
  filter.filter(indices);
  EXPECT_TRUE(indices.empty());
  filter.setBox({10, 10, 0, 5});
  filter.filter(indices);
  EXPECT_TRUE(indices.empty());
  EXPECT_THROW(filter.setBox({0, 0, -1, 1}), pcl::BadArgumentException);
  EXPECT_THROW(filter.setBox({NAN, 0, 1, 1}), pcl::BadArgumentException);
}

TEST(RegionCropValues, TheMaskMustFit)
{
  const auto frame = contractFrame<pcl::PointXYZ>();
  RegionCrop<pcl::PointXYZ> filter;
  filter.setInputCloud(frame);
  cv::Mat1b mask(48, 64, static_cast<unsigned char>(0));
  mask(7, 9) = 3;
  filter.setMask(mask);
  mask(8, 9) = 3; // the filter has its own copy
  pcl::Indices indices;
  filter.filter(indices);
  EXPECT_EQ(indices, (pcl::Indices{7 * 64 + 9}));
  filter.setMask(cv::Mat1b(47, 64, static_cast<unsigned char>(1)));
  EXPECT_THROW(filter.filter(indices), pcl::BadArgumentException);
  EXPECT_THROW(filter.setPolygon({{0, 0}, {1, 1}}), pcl::BadArgumentException);
  EXPECT_THROW(filter.setPolygon({{0, 0}, {1, 1}, {NAN, 1}}),
               pcl::BadArgumentException);
}

TEST(PolygonMask, PolygonsThatShareASideShareNoPixel)
{
  // a fan of triangles around a point covers a convex polygon exactly once
  const cv::Point2f centre(31.3F, 20.7F);
  std::vector<cv::Point2f> ring;
  for (int k = 0; k < 9; ++k)
    ring.emplace_back(31.3F + 25 * std::cos(0.7F * k), 20.7F + 25 * std::sin(0.7F * k));
  cv::Mat1b whole(48, 64), part(48, 64);
  cv::Mat1i sum(48, 64, 0);
  fillPolygon(ring, whole);
  for (std::size_t k = 0; k < ring.size(); ++k) {
    fillPolygon({centre, ring[k], ring[(k + 1) % ring.size()]}, part);
    for (int i = 0; i < static_cast<int>(part.total()); ++i)
      sum(i / 64, i % 64) += part(i / 64, i % 64) / 255;
  }
  ASSERT_GT(cv::countNonZero(whole), 1000);
  for (int v = 0; v < 48; ++v)
    for (int u = 0; u < 64; ++u)
      ASSERT_EQ(sum(v, u), whole(v, u) / 255) << u << ", " << v;
}

TEST(PolygonMask, CountsAreExactForARectangleOnPixelCentres)
{
  cv::Mat1b mask(20, 20);
  fillPolygon({{2, 3}, {7, 3}, {7, 9}, {2, 9}}, mask);
  EXPECT_EQ(cv::countNonZero(mask), 5 * 6);
  EXPECT_EQ(mask(3, 2), 255);
  EXPECT_EQ(mask(9, 7), 0);
}

TEST(EdgePixelsValues, KindsBelongToTheirIndices)
{
  const auto frame = contractFrame<pcl::PointXYZRGB>();
  EdgePixels<pcl::PointXYZRGB> filter;
  filter.setInputCloud(frame);
  pcl::Indices indices;
  int seen = 0;
  for (const int kinds : {int(EDGE_COLOR), int(EDGE_OCCLUSION), int(EDGE_ALL)}) {
    filter.setKinds(kinds);
    filter.filter(indices);
    ASSERT_EQ(filter.getEdgeKinds().size(), indices.size());
    for (std::size_t i = 0; i < indices.size(); ++i) {
      EXPECT_EQ(filter.getEdgeKinds()[i],
                filter.getKindImage()(indices[i] / 64, indices[i] % 64));
      EXPECT_NE(filter.getEdgeKinds()[i] & kinds, 0);
      EXPECT_EQ(filter.getEdgeKinds()[i] & ~kinds, 0);
      seen |= filter.getEdgeKinds()[i];
    }
  }
  EXPECT_EQ(seen & (EDGE_COLOR | EDGE_OCCLUSION), EDGE_COLOR | EDGE_OCCLUSION);
  EXPECT_THROW(filter.setKinds(0), pcl::BadArgumentException);
  EXPECT_THROW(filter.setKinds(8), pcl::BadArgumentException);
  EXPECT_THROW(filter.setThresholdScale(0), pcl::BadArgumentException);
  EXPECT_THROW(filter.setCannyThresholds(50, 20), pcl::BadArgumentException);
  EXPECT_THROW(filter.setNearSideRadius(17), pcl::BadArgumentException);
}

TEST(EdgePixelsValues, SharedImagesGiveTheSame)
{
  const auto frame = contractFrame<pcl::PointXYZRGB>();
  auto images = pcl::make_shared<FrameImages>();
  toFrameImages(*frame, *images);
  EdgePixels<pcl::PointXYZRGB> filter;
  filter.setInputCloud(frame);
  pcl::Indices own, shared;
  filter.filter(own);
  filter.setFrameImages(images);
  filter.filter(shared);
  EXPECT_EQ(own, shared);
  images->points.create(3, 3);
  EXPECT_THROW(filter.filter(shared), pcl::BadArgumentException);
  EXPECT_TRUE(shared.empty());
  EXPECT_TRUE(filter.getEdgeKinds().empty());
}

// A contour two pixels beside the silhouette, on the background and on no depth at all.
TEST(NearSide, ContoursMoveToTheNearSurface)
{
  cv::Mat1f w(40, 60, 1 / 1.5F);
  w.colRange(30, 60) = 1 / 0.8F;
  w.rowRange(0, 10).colRange(26, 30) = 0; // the shadow
  w.rowRange(30, 40).setTo(0);            // nothing is measured below row 30
  cv::Mat1b contours(40, 60, static_cast<unsigned char>(0));
  contours.col(28) = 255;
  contours.col(50) = 255; // print on the near surface
  cv::Mat1b labels(40, 60, static_cast<unsigned char>(0));
  DepthEdges depth;
  EdgeParameters parameters;
  depth.detect(w, {}, parameters.depth, EDGE_OCCLUSION, labels);
  labels.setTo(0);
  addContours(contours, w, depth.getSteps(), parameters, labels);
  for (int v = 0; v < 29; ++v) { // in row 29 the near surface ends below, too
    EXPECT_EQ(labels(v, 30), EDGE_COLOR) << v;
    EXPECT_EQ(labels(v, 50), EDGE_COLOR) << v;
    EXPECT_EQ(cv::countNonZero(labels.row(v)), 2) << v;
  }
  EXPECT_EQ(cv::countNonZero(labels.rowRange(30, 40)), 0) << "no depth, no edge pixel";

  parameters.near_side_radius = 0;
  labels.setTo(0);
  addContours(contours, w, depth.getSteps(), parameters, labels);
  for (int v = 0; v < 40; ++v) {
    EXPECT_EQ(labels(v, 28), v >= 10 && v < 30 ? EDGE_COLOR : EDGE_NONE) << v;
    EXPECT_EQ(labels(v, 30), EDGE_NONE) << v;
  }
}

TEST(EdgeDetectorValues, RedetectEqualsDetectWithTheOtherThresholds)
{
  FrameImages images;
  toFrameImages(*contractFrame<pcl::PointXYZRGB>(), images);
  EdgeDetector a, b;
  EdgeParameters parameters;
  cv::Mat1b first, again, fresh;
  a.detect(images, parameters, first);
  parameters.canny.threshold_scale = 0.3;
  a.redetect(parameters, again);
  b.detect(images, parameters, fresh);
  EXPECT_EQ(cv::countNonZero(again != fresh), 0);
  parameters.canny.threshold_scale = 1;
  a.redetect(parameters, again);
  EXPECT_EQ(cv::countNonZero(again != first), 0);
}

} // namespace
} // namespace hoist
