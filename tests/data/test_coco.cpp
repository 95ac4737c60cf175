// COCO's outlines: polygons and run lengths become the masks that they mean.
#include <hoist/data/coco.h>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <random>

namespace {

using hoist::CocoAnnotation;
using hoist::cocoFromJson;
using hoist::cocoMask;
using hoist::LoadError;
using Json = nlohmann::json;

Json
dataset(const Json& annotation)
{
  Json one = annotation;
  one["id"] = 5;
  one["image_id"] = 2;
  one["category_id"] = 3;
  return {{"images",
           {{{"id", 1}, {"file_name", "a.jpg"}, {"width", 4}, {"height", 3}},
            {{"id", 2}, {"file_name", "b/c.jpg"}, {"width", 40}, {"height", 30}}}},
          {"categories", {{{"id", 3}, {"name", "bucket"}}}},
          {"annotations", {one}}};
}

CocoAnnotation
only(const Json& annotation)
{
  const auto images = cocoFromJson(dataset(annotation).dump());
  EXPECT_EQ(images.size(), 2u);
  EXPECT_TRUE(images.at(0).annotations.empty());
  return images.at(1).annotations.at(0);
}

// Down the columns, of 0 and 1 in turn.
std::vector<std::uint32_t>
runsOf(const cv::Mat1b& mask)
{
  std::vector<std::uint32_t> runs;
  bool inside = false;
  std::uint32_t n = 0;
  for (int u = 0; u < mask.cols; ++u)
    for (int v = 0; v < mask.rows; ++v) {
      if ((mask(v, u) != 0) != inside) {
        runs.push_back(n);
        n = 0;
        inside = !inside;
      }
      ++n;
    }
  runs.push_back(n);
  return runs;
}

// As COCO's own tools pack them.
std::string
packed(const std::vector<std::uint32_t>& runs)
{
  std::string text;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    std::int64_t x = runs[i];
    if (i > 2)
      x -= runs[i - 2];
    for (bool more = true; more;) {
      std::int64_t c = x & 31;
      x >>= 5;
      more = (c & 16) != 0 ? x != -1 : x != 0;
      if (more)
        c |= 32;
      text.push_back(static_cast<char>(c + 48));
    }
  }
  return text;
}

TEST(Coco, RunLengthsComeBack)
{
  std::mt19937 random(1);
  for (int round = 0; round < 100; ++round) {
    cv::Mat1b mask(30, 40, uchar(0));
    const int n = static_cast<int>(random() % 6); // none is a mask, too
    for (int i = 0; i < n; ++i) {
      const int u = static_cast<int>(random() % 30),
                v = static_cast<int>(random() % 20);
      mask(cv::Rect(u, v, 1 + static_cast<int>(random() % 10), 9)).setTo(255);
    }
    const auto runs = runsOf(mask);
    const Json size = {30, 40};
    for (const Json& counts : {Json(runs), Json(packed(runs))}) {
      const CocoAnnotation a =
          only({{"segmentation", {{"size", size}, {"counts", counts}}}});
      EXPECT_EQ(a.runs, runs);
      EXPECT_EQ(cv::countNonZero(cocoMask(a, 40, 30) != mask), 0);
    }
  }
}

TEST(Coco, PolygonsCoverThePixelsWhoseCentreIsInside)
{
  const CocoAnnotation square = only({{"segmentation", {{2, 1, 5, 1, 5, 4, 2, 4}}}});
  cv::Mat1b expected(30, 40, uchar(0));
  expected(cv::Rect(2, 1, 3, 3)).setTo(255);
  EXPECT_EQ(cv::countNonZero(cocoMask(square, 40, 30) != expected), 0);

  // outside of the image in part, and two outlines of one thing
  const CocoAnnotation two =
      only({{"segmentation",
             {{-5, -5, 3, -5, 3, 2, -5, 2}, {38, 28, 60, 28, 60, 60, 38, 60}}}});
  EXPECT_EQ(cv::countNonZero(cocoMask(two, 40, 30)), 6 + 4);

  // any triangle: the area within half a pixel of its outline
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(0, 40), v(0, 30);
  for (int round = 0; round < 200; ++round) {
    const double x[3] = {u(random), u(random), u(random)};
    const double y[3] = {v(random), v(random), v(random)};
    CocoAnnotation triangle;
    triangle.polygons = {{x[0], y[0], x[1], y[1], x[2], y[2]}};
    double outline = 0;
    for (int i = 0; i < 3; ++i)
      outline += std::hypot(x[(i + 1) % 3] - x[i], y[(i + 1) % 3] - y[i]);
    const double area =
        std::abs((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])) / 2;
    EXPECT_NEAR(cv::countNonZero(cocoMask(triangle, 40, 30)), area, 1 + outline / 2);
  }
}

TEST(Coco, WithoutAnOutlineTheBoxCounts)
{
  const CocoAnnotation a = only({{"bbox", {1, 2, 3, 4}}});
  EXPECT_EQ(cv::countNonZero(cocoMask(a, 40, 30)), 12);
  EXPECT_EQ(cv::countNonZero(cocoMask(only(Json::object()), 40, 30)), 0);
}

TEST(Coco, AttributesBesideOrInside)
{
  const CocoAnnotation a = only({{"material", "plastic"},
                                 {"color", "#0aFF10"},
                                 {"attributes", {{"fullness", 1}, {"weight", 2.5}}}});
  EXPECT_EQ(a.category, "bucket");
  EXPECT_EQ(a.material, "plastic");
  EXPECT_EQ(a.rgb, (std::array<int, 3>{10, 255, 16}));
  EXPECT_EQ(a.fullness, true);
  EXPECT_EQ(a.weight, 2.5);
  EXPECT_EQ(only({{"base_rgb", {1, 2, 3}}}).rgb, (std::array<int, 3>{1, 2, 3}));
}

TEST(Coco, SaysWhereAndWhatIsWrong)
{
  const Json good = dataset({{"segmentation", {{0, 0, 9, 0, 9, 9}}}});
  const struct {
    const char *pointer, *value, *position;
  } wrongs[] = {
      {"/images", "null", ""},
      {"/images/0/width", "0", "images[0].width"},
      {"/images/1/id", "1", "images[1].id"},
      {"/images/0/file_name", "null", "images[0]"},
      {"/categories/0/name", "7", "categories[0].name"},
      {"/annotations/0", "[]", "annotations[0]"},
      {"/annotations/0/image_id", "9", "annotations[0].image_id"},
      {"/annotations/0/category_id", "9", "annotations[0].category_id"},
      {"/annotations/0/bbox", "[1,2,-3,4]", "annotations[0].bbox[2]"},
      {"/annotations/0/segmentation/0", "[1,2,3]", "annotations[0].segmentation[0]"},
      {"/annotations/0/segmentation",
       R"({"size":[30,41],"counts":[3]})",
       "annotations[0].segmentation.size"},
      {"/annotations/0/segmentation",
       R"({"size":[30,40],"counts":"P"})",
       "annotations[0].segmentation.counts"},
      {"/annotations/0/segmentation",
       R"({"size":[30,40],"counts":[-1]})",
       "annotations[0].segmentation.counts[0]"},
      {"/annotations/0/color", "\"red\"", "annotations[0].color"}};
  for (const auto& wrong : wrongs) {
    Json bad = good;
    bad[Json::json_pointer(wrong.pointer)] = Json::parse(wrong.value);
    try {
      cocoFromJson(bad.dump(), "x.json");
      ADD_FAILURE() << wrong.pointer << " = " << wrong.value << " was taken";
    }
    catch (const LoadError& error) {
      EXPECT_EQ(error.position(), wrong.position) << error.what();
    }
  }
}

// Any text of run lengths, longer than the image too, is a mask or an error.
TEST(Coco, AnyRunLengthsAreAMaskOrRefused)
{
  std::mt19937 random(3);
  int masks = 0;
  for (int round = 0; round < 5000; ++round) {
    std::string text;
    for (std::size_t i = random() % 12; i > 0; --i)
      text.push_back(static_cast<char>(40 + random() % 80));
    try {
      const CocoAnnotation a =
          only({{"segmentation", {{"size", {30, 40}}, {"counts", text}}}});
      EXPECT_LE(cv::countNonZero(cocoMask(a, 40, 30)), 1200);
      ++masks;
    }
    catch (const LoadError&) {
    }
  }
  EXPECT_GT(masks, 100);
}

} // namespace
