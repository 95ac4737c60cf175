// loadFrame: formats, conversions, lost grids, poses.
#include "temp_folder.h"

#include <hoist/data/frame_fields.h>
#include <hoist/data/load_frame.h>
#include <hoist/data/point_types.h>
#include <hoist/data/pts_io.h>

#include <support/real_data.h>

#include <gtest/gtest.h>

#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <random>

namespace {

using hoist::LoadedFrame;
using hoist::LoadError;
using hoist::loadFrame;
using hoist::LoadOptions;
using hoist::test::TempFolder;
using Cloud = pcl::PointCloud<pcl::PointXYZRGB>;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

// A tilted plane seen by a Kinect of 64 x 48 pixels; every seventh pixel without depth.
Cloud
frame64()
{
  Cloud cloud(64, 48);
  for (int v = 0; v < 48; ++v)
    for (int u = 0; u < 64; ++u) {
      auto& p = cloud(u, v);
      p.r = static_cast<std::uint8_t>(4 * u);
      p.g = static_cast<std::uint8_t>(5 * v);
      p.b = 77;
      p.a = 255;
      if ((u + v) % 7 == 0) {
        p.x = p.y = p.z = nan;
        continue;
      }
      p.z = 1.0f + 0.01f * u + 0.003f * v;
      p.x = (u - 31.5f) * p.z / 52.5f;
      p.y = (v - 23.5f) * p.z / 52.5f;
    }
  cloud.is_dense = false;
  return cloud;
}

void
expectSame(const Cloud& a, const Cloud& b)
{
  ASSERT_EQ(a.width, b.width);
  ASSERT_EQ(a.height, b.height);
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(std::isfinite(a[i].z), std::isfinite(b[i].z)) << i;
    if (std::isfinite(a[i].z)) {
      ASSERT_EQ(a[i].getVector3fMap(), b[i].getVector3fMap()) << i;
    }
    ASSERT_EQ(a[i].rgba | 0xff000000u, b[i].rgba | 0xff000000u) << i;
  }
}

std::string
errorOf(const std::string& file, const LoadOptions& options = {})
{
  try {
    (void)loadFrame(file, options);
  }
  catch (const LoadError& error) {
    EXPECT_EQ(error.file(), file);
    return error.what();
  }
  return "no error";
}

TEST(LoadFrame, EveryFormatGivesTheSameFrame)
{
  const TempFolder folder;
  const Cloud cloud = frame64();
  pcl::PCDWriter pcd;
  pcl::PLYWriter ply;
  pcl::PCLPointCloud2 blob;
  pcl::toPCLPointCloud2(cloud, blob);
  ASSERT_EQ(pcd.writeBinary(folder.name("b.pcd"), cloud), 0);
  ASSERT_EQ(pcd.writeBinaryCompressed(folder.name("c.PCD"), cloud), 0);
  ASSERT_EQ(pcd.writeASCII(folder.name("a.pcd"), cloud, 9), 0); // 9 digits: exact
  ASSERT_EQ(hoist::savePTSFile(folder.name("p.pts"), cloud), 0);
  ASSERT_EQ(ply.write(folder.name("b.ply"), cloud, true, true), 0);
  const std::vector<std::pair<const char*, const char*>> files = {
      {"b.pcd", "PCD binary"},
      {"c.PCD", "PCD binary_compressed"},
      {"a.pcd", "PCD ascii"},
      {"p.pts", "PTS Bumblebee"},
      {"b.ply", "PLY binary_little_endian"}};
  for (const auto& [name, format] : files) {
    SCOPED_TRACE(name);
    const LoadedFrame frame = loadFrame(folder.name(name));
    EXPECT_EQ(frame.format, format);
    EXPECT_TRUE(frame.has_color);
    EXPECT_FALSE(frame.cloud->is_dense);
    EXPECT_FALSE(frame.pose_known);
    expectSame(*frame.cloud, cloud);
    EXPECT_NEAR(frame.intrinsics.fx, 52.5, 1e-3);
    EXPECT_NEAR(frame.intrinsics.cy, 23.5, 1e-3);
  }
}

TEST(LoadFrame, PoseOfPcdAndPly)
{
  const TempFolder folder;
  Cloud cloud = frame64();
  cloud.sensor_origin_ << 1.5f, -2.0f, 3.25f, 0;
  cloud.sensor_orientation_ = Eigen::Quaternionf(
      Eigen::AngleAxisf(0.7f, Eigen::Vector3f(1, 2, 3).normalized()));
  pcl::PCDWriter().writeBinary(folder.name("p.pcd"), cloud);
  pcl::PCLPointCloud2 blob;
  pcl::toPCLPointCloud2(cloud, blob);
  pcl::PLYWriter().writeBinary(folder.name("p.ply"),
                               blob,
                               cloud.sensor_origin_,
                               cloud.sensor_orientation_,
                               true);
  for (const char* name : {"p.pcd", "p.ply"}) {
    SCOPED_TRACE(name);
    const LoadedFrame frame = loadFrame(folder.name(name));
    ASSERT_EQ(frame.cloud->height, 48u);
    EXPECT_TRUE(frame.pose_known);
    EXPECT_TRUE(frame.pose.translation().isApprox(Eigen::Vector3d(1.5, -2, 3.25)));
    // files hold the quaternion with six digits or so
    EXPECT_LT((frame.pose.linear() -
               cloud.sensor_orientation_.toRotationMatrix().cast<double>())
                  .norm(),
              1e-5);
    EXPECT_LT((frame.cloud->sensor_origin_ - cloud.sensor_origin_).head<3>().norm(),
              1e-6f);
  }
}

TEST(LoadFrame, OtherNumberTypes)
{
  const TempFolder folder;
  // double coordinates, which PCL's reader turns into zeros, beside padding and an
  // array; separate colours
  std::string pcd = "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z _ r g b hist\n"
                    "SIZE 8 8 8 1 1 1 1 4\nTYPE F F F U U U U F\n"
                    "COUNT 1 1 1 3 1 1 1 2\nWIDTH 2\nHEIGHT 2\n"
                    "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 4\nDATA binary\n";
  for (int i = 0; i < 4; ++i) {
    const double xyz[3] = {0.25 * i, -0.5, 2.0 + i};
    pcd.append(reinterpret_cast<const char*>(xyz), sizeof xyz);
    pcd += "___";
    pcd += static_cast<char>(10 * i);
    pcd += "\x20\x30";
    pcd.append(8, '\0');
  }
  LoadedFrame frame = loadFrame(folder.write("d.pcd", pcd));
  EXPECT_TRUE(frame.has_color);
  EXPECT_TRUE(frame.cloud->is_dense);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ((*frame.cloud)[i].x, 0.25f * i);
    EXPECT_EQ((*frame.cloud)[i].z, 2.0f + i);
    EXPECT_EQ((*frame.cloud)[i].r, 10 * i);
    EXPECT_EQ((*frame.cloud)[i].b, 0x30);
  }
  // whole millimetres are numbers too; intensity is grey
  frame = loadFrame(folder.write("i.pcd",
                                 "FIELDS intensity x y z\nSIZE 4 2 2 2\nTYPE F I I I\n"
                                 "WIDTH 1\nHEIGHT 2\nDATA ascii\n"
                                 "7 1 -2 3\n300.5 4 5 6\n"));
  EXPECT_EQ((*frame.cloud)[0].y, -2.0f);
  EXPECT_EQ((*frame.cloud)[0].r, 7);
  EXPECT_EQ((*frame.cloud)[1].g, 255);
  // no colour at all
  frame = loadFrame(folder.write("n.pcd",
                                 "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\n"
                                 "HEIGHT 2\nDATA ascii\n1 2 3\n4 5 6"));
  EXPECT_FALSE(frame.has_color);
}

TEST(LoadFrame, ColorPackedAsFloatOrIntegerInText)
{
  const TempFolder folder;
  const std::string head = "FIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F F\nWIDTH 1\n"
                           "HEIGHT 2\nDATA ascii\n";
  // 0x102030 as its bits and as the float of those bits
  const LoadedFrame frame =
      loadFrame(folder.write("c.pcd", head + "1 2 3 1056816\n1 2 3 1.48091467e-39\n"));
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ((*frame.cloud)[i].r, 0x10) << i;
    EXPECT_EQ((*frame.cloud)[i].g, 0x20) << i;
    EXPECT_EQ((*frame.cloud)[i].b, 0x30) << i;
  }
}

TEST(LoadFrame, WhatIsNotMeasuredBecomesNan)
{
  const TempFolder folder;
  const LoadedFrame frame =
      loadFrame(folder.write("i.pcd",
                             "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 3\nHEIGHT 2\n"
                             "DATA ascii\ninf 1 1\n1 nan 1\n0 0 0\n1 1 -1\n1e39 0 1\n"
                             "1 1 1\n"));
  EXPECT_FALSE(frame.cloud->is_dense);
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(std::isnan((*frame.cloud)[i].x)) << i;
    EXPECT_TRUE(std::isnan((*frame.cloud)[i].z)) << i;
  }
  EXPECT_EQ((*frame.cloud)[5].z, 1.0f);
}

// The frame's points without their grid, shuffled.
Cloud
withoutGrid(const Cloud& cloud)
{
  Cloud out;
  for (const auto& p : cloud)
    if (std::isfinite(p.z))
      out.push_back(p);
  std::mt19937 random(1);
  std::shuffle(out.begin(), out.end(), random);
  return out;
}

TEST(LoadFrame, LostGridComesBackByProjection)
{
  const TempFolder folder;
  Cloud kinect(640, 480);
  for (int v = 0; v < 480; ++v)
    for (int u = 0; u < 640; ++u) {
      auto& p = kinect(u, v);
      p.z = (u * 7 + v * 3) % 11 == 0 ? nan : 1.0f + 0.001f * u;
      p.x = static_cast<float>((u - 319.5) * p.z / 525);
      p.y = static_cast<float>((v - 239.5) * p.z / 525);
      p.rgba = 0xff000000u | static_cast<std::uint32_t>(u * v);
      if (!std::isfinite(p.z))
        p.rgba = 0xff000000u; // what was not stored is black
    }
  pcl::PCDWriter().writeBinary(folder.name("k.pcd"), withoutGrid(kinect));
  LoadedFrame frame = loadFrame(folder.name("k.pcd"));
  expectSame(*frame.cloud, kinect);
  EXPECT_FALSE(frame.warnings.empty());
  EXPECT_NEAR(frame.intrinsics.fx, 525, 0.01);

  // another camera must be given
  Cloud other = frame64();
  for (auto& p : other)
    if (!std::isfinite(p.z))
      p.rgba = 0xff000000u;
  pcl::PCDWriter().writeBinary(folder.name("o.pcd"), withoutGrid(other));
  EXPECT_NE(errorOf(folder.name("o.pcd")).find("intrinsics"), std::string::npos);
  LoadOptions options;
  options.intrinsics.emplace();
  options.intrinsics->fx = options.intrinsics->fy = 52.5;
  options.intrinsics->cx = 31.5;
  options.intrinsics->cy = 23.5;
  frame = loadFrame(folder.name("o.pcd"), options);
  expectSame(*frame.cloud, other);
  options.intrinsics->fx = 0;
  EXPECT_NE(errorOf(folder.name("o.pcd"), options), "no error");
}

TEST(LoadFrame, LostGridComesBackByPixelFields)
{
  const TempFolder folder;
  Cloud expected = frame64();
  pcl::PointCloud<hoist::PointXYZRGBUV> records;
  for (std::uint32_t v = 0; v < 48; ++v)
    for (std::uint32_t u = 0; u < 64; ++u) {
      if (!std::isfinite(expected(u, v).z)) {
        expected(u, v).rgba = 0xff000000u;
        continue;
      }
      hoist::PointXYZRGBUV p;
      p.getVector3fMap() = expected(u, v).getVector3fMap();
      p.rgba = expected(u, v).rgba;
      p.u = u;
      p.v = v;
      records.push_back(p);
      p.z *= 2; // a second record behind it does not count
      records.push_back(p);
    }
  pcl::PCDWriter().writeBinaryCompressed(folder.name("r.pcd"), records);
  expectSame(*loadFrame(folder.name("r.pcd")).cloud, expected);
}

TEST(PointTypes, FieldsAreRegisteredAndSurviveAPcdFile)
{
  const TempFolder folder;
  pcl::PointCloud<hoist::PointXYZRGBUV> cloud(3, 1);
  for (unsigned i = 0; i < 3; ++i) {
    cloud[i].x = 0.5f * i;
    cloud[i].r = static_cast<std::uint8_t>(i);
    cloud[i].u = 100 + i;
    cloud[i].v = 200 + i;
  }
  EXPECT_EQ(pcl::getFieldsList(cloud), "x y z rgba u v");
  EXPECT_EQ(pcl::getFieldsList(pcl::PointCloud<hoist::PointXYZUV>()), "x y z u v");
  static_assert(sizeof(hoist::PointXYZRGBUV) == 32, "two SSE registers");
  static_assert(pcl::traits::has_color<hoist::PointXYZRGBUV>::value, "has colour");
  for (const bool binary : {true, false}) {
    ASSERT_EQ(pcl::io::savePCDFile(folder.name("t.pcd"), cloud, binary), 0);
    pcl::PointCloud<hoist::PointXYZRGBUV> back;
    ASSERT_EQ(pcl::io::loadPCDFile(folder.name("t.pcd"), back), 0);
    ASSERT_EQ(back.size(), 3u);
    for (unsigned i = 0; i < 3; ++i) {
      EXPECT_EQ(back[i].x, cloud[i].x);
      EXPECT_EQ(back[i].rgba, cloud[i].rgba);
      EXPECT_EQ(back[i].u, cloud[i].u);
      EXPECT_EQ(back[i].v, cloud[i].v);
    }
  }
}

TEST(LoadFrameRealData, EveryKinectFrameLoads)
{
  HOIST_SKIP_WITHOUT_REAL_DATA();
  std::size_t scenes = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(*hoist::test::realData() / "mosd/scenes")) {
    SCOPED_TRACE(entry.path().filename());
    const LoadedFrame frame = loadFrame(entry.path().string());
    EXPECT_EQ(frame.cloud->width, 640u);
    EXPECT_EQ(frame.cloud->height, 480u);
    EXPECT_TRUE(frame.has_color);
    // the truth's README: 525, 319.5, 239.5, rms 2e-5 px
    EXPECT_NEAR(frame.intrinsics.fx, 525, 0.01);
    EXPECT_NEAR(frame.intrinsics.fy, 525, 0.01);
    EXPECT_NEAR(frame.intrinsics.cx, 319.5, 0.01);
    EXPECT_NEAR(frame.intrinsics.cy, 239.5, 0.01);
    EXPECT_LT(frame.intrinsics.rms, 1e-3);
    ++scenes;
  }
  EXPECT_EQ(scenes, 78u);
  const auto kinect = *hoist::test::realData() / "kinect";
  EXPECT_TRUE(loadFrame((kinect / "office1.pcd").string()).pose_known);
  EXPECT_NE(errorOf((kinect / "stereo_left.pcd").string()).find("no field x"),
            std::string::npos);
}

TEST(LoadFrameRealData, PtsAndPcdOfOneFrameAreTheSame)
{
  HOIST_SKIP_WITHOUT_REAL_DATA();
  const TempFolder folder;
  for (const char* scene : {"test0", "learn33"}) {
    const auto path =
        *hoist::test::realData() / "mosd/scenes" / (std::string(scene) + ".pcd");
    const LoadedFrame pcd = loadFrame(path.string());
    ASSERT_EQ(hoist::savePTSFile(folder.name("f.pts"), *pcd.cloud), 0);
    const LoadedFrame pts = loadFrame(folder.name("f.pts"));
    expectSame(*pts.cloud, *pcd.cloud);
    EXPECT_EQ(pts.intrinsics.fx, pcd.intrinsics.fx);
  }
}

// Further fields of every kind of PCD file are what was written, as floats; nothing
// that a frame is made of is among them.
TEST(LoadFrameFields, AreThoseOfTheFile)
{
  pcl::PointCloud<pcl::PointXYZRGBNormal> cloud(64, 48);
  const Cloud frame = frame64();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    auto& p = cloud[i];
    p.x = frame[i].x;
    p.y = frame[i].y;
    p.z = frame[i].z;
    p.rgba = frame[i].rgba;
    p.normal_x = 0.25f * static_cast<float>(i);
    p.normal_y = -1;
    p.normal_z = nan;
    p.curvature = static_cast<float>(i % 64);
  }
  const TempFolder folder;
  pcl::PCDWriter writer;
  for (const char* name : {"ascii.pcd", "binary.PCD", "compressed.pcd"}) {
    const std::string file = folder.name(name);
    ASSERT_EQ(name[0] == 'a'   ? writer.writeASCII(file, cloud, 9)
              : name[0] == 'b' ? writer.writeBinary(file, cloud)
                               : writer.writeBinaryCompressed(file, cloud),
              0);
    const auto fields = hoist::loadFrameFields(file);
    ASSERT_EQ(fields.size(), 4U) << name;
    EXPECT_EQ(fields[0].name, "normal_x");
    EXPECT_EQ(fields[3].name, "curvature");
    for (const auto& field : fields)
      ASSERT_EQ(field.values.size(), cloud.size()) << name;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      EXPECT_EQ(fields[0].values[i], cloud[i].normal_x);
      EXPECT_EQ(fields[1].values[i], -1);
      EXPECT_TRUE(std::isnan(fields[2].values[i]));
      EXPECT_EQ(fields[3].values[i], cloud[i].curvature);
    }
    EXPECT_EQ(hoist::loadFrameFields(file, 2).size(), 2U);
    expectSame(*loadFrame(file).cloud, frame); // the frame is the same with them
  }
}

TEST(LoadFrameFields, OfWholeNumbersAndNotOfPadding)
{
  const TempFolder folder;
  const std::string header = "VERSION 0.7\nFIELDS x y z label _ flags pair\n"
                             "SIZE 4 4 4 4 1 1 4\nTYPE F F F U U I F\n"
                             "COUNT 1 1 1 1 4 1 2\n";
  const std::string points = "1 2 3 4000000 9 9 9 9 -5 1 2\n"
                             "1 2 3 7 9 9 9 9 6 1 2\n";
  const auto grid = hoist::loadFrameFields(folder.write(
      "grid.pcd", header + "WIDTH 1\nHEIGHT 2\nPOINTS 2\nDATA ascii\n" + points));
  ASSERT_EQ(grid.size(), 2U); // not the pair: which of the two?
  EXPECT_EQ(grid[0].name, "label");
  EXPECT_EQ(grid[0].values, (std::vector<float>{4000000, 7}));
  EXPECT_EQ(grid[1].values, (std::vector<float>{-5, 6}));
  // without its own grid the order of the points is lost
  EXPECT_TRUE(
      hoist::loadFrameFields(
          folder.write("row.pcd",
                       header + "WIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n" + points))
          .empty());
  EXPECT_TRUE(hoist::loadFrameFields(folder.write("a.pts", "1\n1 2 3\n")).empty());
  EXPECT_THROW(hoist::loadFrameFields(folder.write("bad.pcd", "no header\n")),
               LoadError);
}

} // namespace
