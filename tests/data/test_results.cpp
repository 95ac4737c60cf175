// Results in and out, and files that appear whole or not at all.
#include "temp_folder.h"

#include <hoist/data/atomic_file.h>
#include <hoist/data/load_frame.h>
#include <hoist/data/result_io.h>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <pcl/io/pcd_io.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <random>
#include <thread>

namespace {

using namespace hoist;
using hoist::test::TempFolder;

double
randomDouble(std::mt19937_64& random)
{
  // any bits that are a finite number
  for (;;) {
    const std::uint64_t bits = random();
    double value = 0;
    std::memcpy(&value, &bits, sizeof value);
    if (std::isfinite(value))
      return value;
  }
}

FrameResult
randomResult(unsigned seed)
{
  std::mt19937_64 random(seed);
  const auto number = [&] { return randomDouble(random); };
  const auto vector = [&] { return Eigen::Vector3d(number(), number(), number()); };
  FrameResult r;
  r.scene = "scene \"7\", \\ and \n line \xc3\xa4";
  r.mode = "full";
  r.width = 640;
  r.height = 480;
  r.intrinsics.fx = number();
  r.intrinsics.rms = number();
  r.intrinsics.inliers = 77;
  r.pose_known = seed % 2 == 0;
  if (r.pose_known) {
    r.pose.linear() =
        Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 2) / 3).toRotationMatrix();
    r.pose.translation() = Eigen::Vector3d(1, 2, 3);
  }
  r.diagnostics.counts.add("edge pixels", 1234);
  r.diagnostics.counts.add("line segments", 56);
  r.diagnostics.rejected.add("too small", 3);
  for (int i = 0; i < 3; ++i) {
    RecognizedCuboid item;
    item.cuboid.center = vector();
    item.cuboid.size = vector();
    item.cuboid.axes.col(0) = vector();
    item.cuboid.score = number();
    item.cuboid.model = static_cast<CuboidModel>(i + 1);
    item.cuboid.size_sigma = vector();
    item.cuboid.size_sigma[1] = std::numeric_limits<double>::quiet_NaN();
    item.cuboid.observed_faces = {true, false, true, false, false, i == 1};
    item.cuboid.dimension_source = {
        DimensionSource::measured, DimensionSource::unknown, DimensionSource::support};
    item.features.rgb = {1, 2, static_cast<unsigned char>(200 + i)};
    item.features.lab = {number(), number(), number()};
    item.features.color_name = "orange";
    item.features.material = "precast \"concrete\", grey";
    item.features.weight = number();
    r.cuboids.push_back(item);
  }
  return r;
}

class Json : public testing::TestWithParam<unsigned> {};

TEST_P(Json, DoublesComeBackBitForBit)
{
  const FrameResult a = randomResult(GetParam());
  for (const int indent : {1, -1}) {
    const FrameResult b = fromJson(toJson(a, indent));
    EXPECT_EQ(b.scene, a.scene);
    EXPECT_EQ(b.mode, a.mode);
    EXPECT_EQ(b.intrinsics.fx, a.intrinsics.fx);
    EXPECT_EQ(b.intrinsics.inliers, a.intrinsics.inliers);
    EXPECT_EQ(b.pose_known, a.pose_known);
    EXPECT_EQ(b.pose.matrix(), a.pose.matrix());
    EXPECT_EQ(b.diagnostics.counts["line segments"], 56u);
    EXPECT_EQ(b.diagnostics.rejected["too small"], 3u);
    ASSERT_EQ(b.cuboids.size(), a.cuboids.size());
    for (std::size_t i = 0; i < a.cuboids.size(); ++i) {
      const Cuboid &p = a.cuboids[i].cuboid, &q = b.cuboids[i].cuboid;
      EXPECT_EQ(q.center, p.center);
      EXPECT_EQ(q.size, p.size);
      EXPECT_EQ(q.axes, p.axes);
      EXPECT_EQ(q.score, p.score);
      EXPECT_EQ(q.model, p.model);
      EXPECT_EQ(q.size_sigma[0], p.size_sigma[0]);
      EXPECT_TRUE(std::isnan(q.size_sigma[1]));
      EXPECT_TRUE(std::isnan(q.rotation_sigma));
      EXPECT_EQ(q.observed_faces, p.observed_faces);
      EXPECT_EQ(q.dimension_source, p.dimension_source);
      const CuboidFeatures &f = a.cuboids[i].features, &g = b.cuboids[i].features;
      EXPECT_EQ(g.rgb, f.rgb);
      EXPECT_EQ(g.lab, f.lab);
      EXPECT_EQ(g.color_name, f.color_name);
      EXPECT_EQ(g.material, f.material);
      EXPECT_EQ(g.weight, f.weight);
    }
    // and the same text again
    EXPECT_EQ(toJson(b, indent) == toJson(a, indent), true);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Json, testing::Range(1u, 21u));

TEST(Json, SchemaIsWhatTheEvaluationReads)
{
  FrameResult result;
  result.scene = "s";
  RecognizedCuboid item;
  item.cuboid.center = {1, 2, 3};
  item.cuboid.size = {0.3, 0.2, 0.1};
  item.cuboid.axes =
      Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()).toRotationMatrix();
  item.cuboid.score = 0.5;
  result.cuboids.push_back(item);
  auto json = nlohmann::json::parse(toJson(result));
  EXPECT_EQ(json.at("scene"), "s");
  const auto cuboid = json.at("cuboids").at(0);
  EXPECT_EQ(cuboid.at("center"), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(cuboid.at("size"), (std::vector<double>{0.3, 0.2, 0.1}));
  EXPECT_EQ(cuboid.at("score"), 0.5);
  // rows of rows: entry [i][k] is component i of axis k
  EXPECT_EQ(cuboid.at("rotation").at(1).at(2), item.cuboid.axes(1, 2));
  EXPECT_TRUE(cuboid.at("size_sigma").at(0).is_null());
  EXPECT_FALSE(cuboid.contains("world"));
  EXPECT_TRUE(json.at("pose").is_null());

  result.pose_known = true;
  result.pose.translation() = Eigen::Vector3d(10, 0, 0);
  json = nlohmann::json::parse(toJson(result));
  const auto& world = json.at("cuboids").at(0).at("world");
  EXPECT_EQ(world.at("center"), (std::vector<double>{11, 2, 3}));
  EXPECT_EQ(world.at("size"), cuboid.at("size"));
}

TEST(Json, BadTextIsALoadError)
{
  const std::string good = toJson(randomResult(1), -1);
  EXPECT_THROW((void)fromJson(""), LoadError);
  EXPECT_THROW((void)fromJson("[]"), LoadError);
  EXPECT_THROW((void)fromJson("{\"scene\": 5}"), LoadError);
  EXPECT_THROW((void)loadJson("no/such/file.json"), LoadError);
  std::string bad = good;
  bad.replace(bad.find("\"II\""), 4, "\"IV\"");
  EXPECT_THROW((void)fromJson(bad), LoadError);
  for (std::size_t n = 0; n + 2 < good.size(); n += 7)
    EXPECT_THROW((void)fromJson(good.substr(0, n)), LoadError);
  // bytes that are no UTF-8 in a name do not cost the result
  FrameResult result;
  result.scene = "caf\xe9";
  EXPECT_NO_THROW((void)fromJson(toJson(result)));
}

TEST(Csv, HasOneFieldPerColumn)
{
  const FrameResult result = randomResult(2);
  const std::string text = toCsv(result);
  // a small RFC 4180 parser
  std::vector<std::vector<std::string>> rows(1, {""});
  bool inside = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') {
      if (inside && i + 1 < text.size() && text[i + 1] == '"') {
        rows.back().back() += c;
        ++i;
      }
      else
        inside = !inside;
    }
    else if (inside)
      rows.back().back() += c;
    else if (c == ',')
      rows.back().emplace_back();
    else if (c == '\n')
      rows.push_back({""});
    else if (c != '\r')
      rows.back().back() += c;
  }
  rows.pop_back();
  ASSERT_EQ(rows.size(), 4u);
  for (const auto& row : rows)
    EXPECT_EQ(row.size(), rows[0].size());
  EXPECT_EQ(rows[2][0], result.scene);
  EXPECT_EQ(std::stod(rows[2][4]), result.cuboids[1].cuboid.center.x());
  EXPECT_EQ(rows[1][15], ""); // a sigma that is not known
}

TEST(LabelledCloud, LabelsThePixelsOfEachCuboid)
{
  pcl::PointCloud<pcl::PointXYZRGB> cloud(4, 3);
  for (int i = 0; i < 12; ++i) {
    cloud[i].x = static_cast<float>(i);
    cloud[i].r = static_cast<std::uint8_t>(i);
  }
  cloud.sensor_origin_ << 1, 2, 3, 0;
  FrameResult result;
  result.cuboids.resize(2);
  result.cuboids[0].cuboid.indices = {0, 1, 2};
  result.cuboids[0].cuboid.score = 0.4;
  result.cuboids[1].cuboid.indices = {2, 3};
  result.cuboids[1].cuboid.score = 0.9;
  const TempFolder folder;
  saveLabelledCloud(folder.name("l.pcd"), cloud, result);
  pcl::PointCloud<pcl::PointXYZRGBL> back;
  ASSERT_EQ(pcl::io::loadPCDFile(folder.name("l.pcd"), back), 0);
  ASSERT_EQ(back.width, 4u);
  ASSERT_EQ(back.height, 3u);
  EXPECT_EQ(back.sensor_origin_[1], 2.0f);
  const std::vector<std::uint32_t> labels = {1, 1, 2, 2, 0, 0, 0, 0, 0, 0, 0, 0};
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(back[i].label, labels[i]) << i;
    EXPECT_EQ(back[i].x, cloud[i].x);
    EXPECT_EQ(back[i].r, cloud[i].r);
  }
  // nothing but the file is left in the folder
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
  result.cuboids[0].cuboid.indices = {12};
  EXPECT_THROW((void)labelledCloud(cloud, result), pcl::BadArgumentException);
  result.cuboids[0].cuboid.indices = {-1};
  EXPECT_THROW(saveLabelledCloud(folder.name("m.pcd"), cloud, result),
               pcl::BadArgumentException);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(Wireframe, HasTheEdgesOfTheBox)
{
  FrameResult result;
  result.cuboids.resize(2);
  result.cuboids[0].cuboid.size = {3, 2, 1};
  result.cuboids[1].cuboid.size = {6, 5, 4};
  result.cuboids[1].cuboid.center = {0, 0, 9};
  std::istringstream in(toWireframePly(result));
  std::string line;
  while (std::getline(in, line) && line != "end_header") {
  }
  std::vector<Eigen::Vector3d> vertices(16);
  for (auto& v : vertices) {
    double r = 0, g = 0, b = 0;
    in >> v.x() >> v.y() >> v.z() >> r >> g >> b;
  }
  std::vector<double> lengths;
  for (int i = 0; i < 24; ++i) {
    std::size_t a = 0, b = 0;
    in >> a >> b;
    ASSERT_LT(std::max(a, b), 16u);
    lengths.push_back((vertices[a] - vertices[b]).norm());
  }
  ASSERT_TRUE(in);
  std::sort(lengths.begin(), lengths.end());
  for (int i = 0; i < 24; ++i)
    EXPECT_NEAR(lengths[i], i / 4 + 1, 1e-12); // four edges of each length
}

TEST(AtomicFile, AppearsWholeOrNotAtAll)
{
  const TempFolder folder;
  const std::string name = folder.name("a.txt");
  writeFileAtomically(name, "old");
  {
    AtomicFile file(name);
    file.write("half of the n");
    EXPECT_EQ(hoist::test::readFile(name), "old");
  } // no commit
  EXPECT_EQ(hoist::test::readFile(name), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
  writeFileAtomically(name, "new");
  EXPECT_EQ(hoist::test::readFile(name), "new");
  EXPECT_THROW(writeFileAtomically(folder.name("no/such/folder"), "x"),
               pcl::IOException);
  std::filesystem::create_directory(folder.path() / "d");
  EXPECT_THROW(writeFileAtomically(folder.name("d"), "x"), pcl::IOException);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2);
}

TEST(AtomicFile, ManyWritersLeaveOneWholeFile)
{
  const TempFolder folder;
  const std::string name = folder.name("a.txt");
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (int i = 0; i < 20; ++i)
        writeFileAtomically(name, std::string(100000, static_cast<char>('a' + t)));
    });
  for (auto& thread : threads)
    thread.join();
  const std::string text = hoist::test::readFile(name);
  ASSERT_EQ(text.size(), 100000u);
  EXPECT_EQ(text.find_first_not_of(text[0]), std::string::npos);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

} // namespace
