#include "labels.h"
#include "wireframe.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hoist {
namespace {

FrameImages
camera()
{
  FrameImages images;
  images.intrinsics.fx = images.intrinsics.fy = 500;
  images.intrinsics.cx = 319.5;
  images.intrinsics.cy = 239.5;
  images.inverse_depth = cv::Mat1f(480, 640, 0.0f); // nothing was measured
  return images;
}

Cuboid
cube(double x, double z, double side)
{
  Cuboid cuboid;
  cuboid.center = {x, 0, z};
  cuboid.axes.setIdentity();
  cuboid.size = {side, side, side};
  return cuboid;
}

double
length(const std::vector<EdgePiece>& pieces, bool hidden)
{
  double sum = 0;
  for (const EdgePiece& piece : pieces)
    if (piece.hidden == hidden)
      sum += cv::norm(piece.to - piece.from);
  return sum;
}

// Seen straight on from the middle only the front face is seen: four edges of
// 500 * 0.4 / 0.8 pixels; to 5 % because pieces are cut on a raster of 3 pixels.
TEST(Wireframes, OfACubeSeenStraightOnTheFrontIsSeen)
{
  const Wireframes one({cube(0, 1.0, 0.4)}, camera(), 1);
  EXPECT_NEAR(length(one.edges(0), false), 4 * 250.0, 50.0);
  EXPECT_GT(length(one.edges(0), true), 100.0);
}

TEST(Wireframes, ANearerCuboidHidesAFartherOneInAnyOrder)
{
  const Cuboid small = cube(0, 2.0, 0.2), large = cube(0, 1.0, 0.4);
  const Wireframes first({small, large}, camera(), 2),
      last({large, small}, camera(), 2);
  EXPECT_EQ(length(first.edges(0), false), 0.0);
  EXPECT_EQ(length(last.edges(1), false), 0.0);
  EXPECT_GT(length(first.edges(1), false), 100.0);
  const cv::Mat1i owners = first.owners({1280, 960});
  EXPECT_EQ(owners(480, 640), 1);
  EXPECT_EQ(owners(20, 20), -1);
  EXPECT_EQ(cv::countNonZero(owners == 0), 0);
}

TEST(Wireframes, WhatWasMeasuredBeforeAnEdgeHidesItAndItsOwnSurfaceDoesNot)
{
  FrameImages images = camera();
  images.inverse_depth.setTo(1.0f / 0.8f); // the front face's own depth
  EXPECT_GT(length(Wireframes({cube(0, 1.0, 0.4)}, images, 1).edges(0), false), 900.0);
  images.inverse_depth.setTo(1.0f / 0.5f); // a wall before it
  EXPECT_EQ(length(Wireframes({cube(0, 1.0, 0.4)}, images, 1).edges(0), false), 0.0);
}

TEST(Labels, StandBesideThingsAndInsideThePicture)
{
  cv::Mat1i owners(960, 1280, -1);
  owners(cv::Rect(500, 300, 200, 200)) = 0;
  owners(cv::Rect(710, 300, 200, 200)) = 1;
  LabelPlacer labels(owners, 1);
  labels.add({"first", "a line below"}, 0, {0, 255, 255});
  labels.add({"second", "a line below"}, 1, {255, 0, 255});
  cv::Mat3b picture(960, 1280, cv::Vec3b(200, 200, 200));
  labels.draw(picture);
  // a label is a dark panel; on the things there are but leaders and their ends
  cv::Mat1b changed;
  cv::inRange(picture, cv::Scalar(0, 0, 0), cv::Scalar(90, 90, 90), changed);
  const int panels = cv::countNonZero(changed);
  EXPECT_GT(panels, 5000);
  EXPECT_LT(cv::countNonZero(changed(cv::Rect(500, 300, 410, 200))), panels / 10);
}

} // namespace
} // namespace hoist
