#include <hoist/data/load_frame.h>
#include <hoist/recognition/yolox_detector.h>

#include <support/real_data.h>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

namespace hoist {
namespace {

namespace fs = std::filesystem;

const std::string fixtures = HOIST_FIXTURES;
const std::string two_colors = fixtures + "/yolox_two_colors.onnx";

std::string
complaint(const std::string& model, const std::vector<std::string>& names)
{
  try {
    YoloxNetwork network(model, names);
  }
  catch (const LoadError& error) {
    return error.what();
  }
  return "";
}

// Inverse of the decoding, from the box and its cell.
void
encode(cv::Mat1f& output, int row, int x, int y, int stride, const cv::Rect2d& box)
{
  output(row, 0) = static_cast<float>((box.x + box.width / 2) / stride - x);
  output(row, 1) = static_cast<float>((box.y + box.height / 2) / stride - y);
  output(row, 2) = static_cast<float>(std::log(box.width / stride));
  output(row, 3) = static_cast<float>(std::log(box.height / stride));
}

TEST(Yolox, DecodingUndoesEncodingInEveryGrid)
{
  const cv::Size input(96, 64);
  const int cells = 96 + 24 + 6;
  struct Place {
    int row, x, y, stride;
  };
  for (const Place& p : {Place{0, 0, 0, 8},
                         Place{12 + 5, 5, 1, 8},
                         Place{96 + 6 + 2, 2, 1, 16},
                         Place{96 + 24 + 5, 2, 1, 32}}) {
    cv::Mat1f output = cv::Mat1f::zeros(cells, 7);
    const cv::Rect2d box(10.25, 20.5, 31, 17);
    encode(output, p.row, p.x, p.y, p.stride, box);
    output(p.row, 4) = 0.8f;
    output(p.row, 5) = 0.25f;
    output(p.row, 6) = 0.5f;
    std::vector<cv::Rect2d> boxes;
    std::vector<float> scores;
    std::vector<int> classes;
    decodeYolox(output, input, 0.3, boxes, scores, classes);
    ASSERT_EQ(boxes.size(), 1u);
    EXPECT_NEAR(boxes[0].x, box.x, 1e-4); // float's rounding of the row
    EXPECT_NEAR(boxes[0].y, box.y, 1e-4);
    EXPECT_NEAR(boxes[0].width, box.width, 1e-4);
    EXPECT_NEAR(boxes[0].height, box.height, 1e-4);
    EXPECT_FLOAT_EQ(scores[0], 0.4f);
    EXPECT_EQ(classes[0], 1);
    decodeYolox(output, input, 0.41, boxes, scores, classes);
    EXPECT_TRUE(boxes.empty());
    output(p.row, 2) = std::numeric_limits<float>::quiet_NaN();
    decodeYolox(output, input, 0.3, boxes, scores, classes);
    EXPECT_TRUE(boxes.empty());
  }
}

// Black but for one coloured rectangle, at z = 1.
pcl::PointCloud<pcl::PointXYZRGB>::Ptr
cloudWith(const cv::Rect& colored, int r, int g)
{
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZRGB>>(192, 96);
  for (int v = 0; v < 96; ++v)
    for (int u = 0; u < 192; ++u) {
      pcl::PointXYZRGB& p = cloud->at(u, v);
      p.x = static_cast<float>(u - 96) / 200;
      p.y = static_cast<float>(v - 48) / 200;
      p.z = 1;
      if (colored.contains(cv::Point(u, v))) {
        p.r = static_cast<std::uint8_t>(r);
        p.g = static_cast<std::uint8_t>(g);
      }
    }
  return cloud;
}

// A model that says red and green cells. The frame is twice the network's width, so a
// cell of stride 8 is 16 pixels wide and its box, of two strides, 32.
TEST(Yolox, FindsWhatItsModelKnowsWhereItIs)
{
  YoloxDetector<pcl::PointXYZRGB> detector(two_colors, {"red", "green"});
  const auto cloud = cloudWith({64, 32, 16, 16}, 0, 255);
  cloud->at(70, 40).x = std::numeric_limits<float>::quiet_NaN();
  detector.setInputCloud(cloud);
  std::vector<Detection> found;
  ASSERT_TRUE(detector.detect(found));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].object_class, "green");
  EXPECT_GT(found[0].score, 0.9);
  EXPECT_NEAR(found[0].box.x, 56, 1e-3);
  EXPECT_NEAR(found[0].box.y, 24, 1e-3);
  EXPECT_NEAR(found[0].box.width, 32, 1e-3);
  EXPECT_NEAR(found[0].box.height, 32, 1e-3);
  EXPECT_EQ(found[0].indices.size(), 32u * 32u - 1);
  EXPECT_TRUE(std::is_sorted(found[0].indices.begin(), found[0].indices.end()));
  EXPECT_EQ(found[0].indices.front(), 24 * 192 + 56);

  detector.setInputCloud(cloudWith({64, 32, 16, 16}, 255, 0));
  ASSERT_TRUE(detector.detect(found));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].object_class, "red");
}

TEST(Yolox, BoxesEndAtTheFrame)
{
  YoloxDetector<pcl::PointXYZRGB> detector(two_colors, {"red", "green"});
  detector.setInputCloud(cloudWith({0, 0, 16, 16}, 255, 0));
  std::vector<Detection> found;
  ASSERT_TRUE(detector.detect(found));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].box.x, 0);
  EXPECT_EQ(found[0].box.y, 0);
  EXPECT_NEAR(found[0].box.width, 24, 1e-3);
}

TEST(Yolox, OnlyGivenIndicesAreAnswered)
{
  YoloxDetector<pcl::PointXYZRGB> detector(two_colors, {"red", "green"});
  detector.setInputCloud(cloudWith({64, 32, 16, 16}, 255, 0));
  detector.setIndices(pcl::make_shared<pcl::Indices>(pcl::Indices{3, 40 * 192 + 70}));
  std::vector<Detection> found;
  ASSERT_TRUE(detector.detect(found));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].indices, pcl::Indices{40 * 192 + 70});
  detector.setIndices(pcl::make_shared<pcl::Indices>(pcl::Indices{3}));
  ASSERT_TRUE(detector.detect(found));
  EXPECT_TRUE(found.empty());
}

TEST(Yolox, OverlapDecidesHowManyBoxesOfNeighbouringCellsStay)
{
  // two cells side by side: boxes of two strides overlap by a third
  YoloxDetector<pcl::PointXYZRGB> detector(two_colors, {"red", "green"});
  detector.setInputCloud(cloudWith({64, 32, 32, 16}, 255, 0));
  std::vector<Detection> found;
  detector.setScoreThreshold(0.6); // a cell of stride 16 is half red: 0.5
  detector.setOverlapThreshold(0.34);
  ASSERT_TRUE(detector.detect(found));
  EXPECT_EQ(found.size(), 2u);
  detector.setOverlapThreshold(0.32);
  ASSERT_TRUE(detector.detect(found));
  EXPECT_EQ(found.size(), 1u);
}

TEST(Yolox, UnusableInputIsFalseAndClearsTheAnswer)
{
  YoloxDetector<pcl::PointXYZRGB> detector(two_colors, {"red", "green"});
  std::vector<Detection> found(1);
  EXPECT_FALSE(detector.detect(found));
  EXPECT_TRUE(found.empty());
  detector.setInputCloud(pcl::make_shared<pcl::PointCloud<pcl::PointXYZRGB>>(5, 1));
  EXPECT_FALSE(detector.detect(found));
  detector.setInputCloud(cloudWith({}, 0, 0));
  detector.setIndices(pcl::make_shared<pcl::Indices>(pcl::Indices{192 * 96}));
  EXPECT_FALSE(detector.detect(found));
}

TEST(Yolox, BadModelsAreToldInOneClearError)
{
  const std::vector<std::string> names = {"red", "green"};
  EXPECT_EQ(complaint(two_colors, names), "");
  EXPECT_EQ(complaint(two_colors, {"red"}),
            two_colors + ": the model tells 2 classes, the list has 1");
  const std::string four = fixtures + "/yolox_four_channels.onnx";
  EXPECT_EQ(complaint(four, names),
            four + ": expected an input of 1x3xHxW, H and W multiples of 32, found "
                   "1x4x64x96");
  const std::string turned = fixtures + "/yolox_transposed.onnx";
  EXPECT_EQ(complaint(turned, names),
            turned + ": expected an output of 1x126x(5 + classes), found 1x7x126");
  const std::string two = fixtures + "/yolox_two_outputs.onnx";
  EXPECT_EQ(complaint(two, names),
            two + ": expected a model of one output, this has 2");
  EXPECT_EQ(complaint("no/such.onnx", names), "no/such.onnx: cannot be read");
  EXPECT_EQ(complaint(fixtures, names), fixtures + ": cannot be read");
}

TEST(Yolox, AFileCutAnywhereIsRefused)
{
  std::ifstream in(two_colors, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const fs::path cut = fs::path(::testing::TempDir()) / "hoist_yolox_cut.onnx";
  for (const double share : {0.0, 0.01, 0.3, 0.6, 0.9, 0.999}) {
    const std::string part =
        bytes.substr(0, static_cast<std::size_t>(share * bytes.size()));
    std::ofstream(cut, std::ios::binary) << part;
    EXPECT_NE(complaint(cut.string(), {"red", "green"}), "") << share;
  }
  std::ofstream(cut, std::ios::binary) << "this is no model";
  EXPECT_NE(complaint(cut.string(), {"red", "green"}), "");
  fs::remove(cut);
}

TEST(Yolox, ListsOfClassesAreChecked)
{
  const fs::path file = fs::path(::testing::TempDir()) / "hoist_yolox_classes.txt";
  const auto load = [&](const std::string& text) -> std::string {
    std::ofstream(file, std::ios::binary) << text;
    try {
      std::string all;
      for (const std::string& name : loadClassNames(file))
        all += name + ";";
      return all;
    }
    catch (const LoadError& error) {
      return error.position() + " " + error.reason();
    }
  };
  EXPECT_EQ(load("hard hat\r\nbucket\n\n"), "hard hat;bucket;");
  EXPECT_EQ(load("a\n\nb\n"), "2 a class without a name");
  EXPECT_EQ(load("a\nb\na\n"), "3 'a' is given twice");
  EXPECT_EQ(load(""), " holds no names of classes");
  fs::remove(file);
  EXPECT_THROW(loadClassNames(file), LoadError);
}

TEST(Yolox, KnowsTheChairsOfARealOffice)
{
  HOIST_SKIP_WITHOUT_REAL_DATA();
  const fs::path real = *test::realData();
  YoloxDetector<pcl::PointXYZRGB> detector(
      (real / "models/yolox_nano.onnx").string(),
      loadClassNames(real / "models/coco_classes.txt"));
  detector.setInputCloud(loadFrame((real / "kinect/office1.pcd").string()).cloud);
  std::vector<Detection> found;
  ASSERT_TRUE(detector.detect(found));
  for (const Detection& d : found)
    std::printf("%s %.2f at %.0f %.0f, %.0f x %.0f, %zu points\n",
                d.object_class.c_str(),
                d.score,
                d.box.x,
                d.box.y,
                d.box.width,
                d.box.height,
                d.indices.size());
  EXPECT_TRUE(std::any_of(found.begin(), found.end(), [](const Detection& d) {
    return d.object_class == "chair" && d.indices.size() > 1000;
  }));
}

} // namespace
} // namespace hoist
