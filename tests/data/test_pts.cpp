// PTS files: every dialect, every tolerated oddity, every error, the round trip.
#include "support/sanitizers.h"
#include "temp_folder.h"

#include <hoist/data/point_types.h>
#include <hoist/data/pts_io.h>

#include <support/real_data.h>

#include <gtest/gtest.h>

#include <pcl/console/print.h>
#include <pcl/point_types.h>

#include <sys/resource.h>

#include <clocale>
#include <cmath>
#include <cstring>
#include <limits>
#include <locale>
#include <random>
#include <sstream>

namespace {

using hoist::LoadError;
using hoist::PTSOptions;
using hoist::PTSReport;
using hoist::readPTS;
using hoist::test::TempFolder;

std::vector<std::string>
fieldNames(const pcl::PCLPointCloud2& cloud)
{
  std::vector<std::string> names;
  for (const auto& field : cloud.fields)
    names.push_back(field.name);
  return names;
}

float
value(const pcl::PCLPointCloud2& cloud, std::size_t point, std::size_t field)
{
  float out = 0;
  std::memcpy(&out,
              &cloud.data.at(point * cloud.point_step + cloud.fields.at(field).offset),
              4);
  return out;
}

std::uint32_t
word(const pcl::PCLPointCloud2& cloud, std::size_t point, std::size_t field)
{
  std::uint32_t out = 0;
  std::memcpy(&out,
              &cloud.data.at(point * cloud.point_step + cloud.fields.at(field).offset),
              4);
  return out;
}

// The message of the LoadError that reading this text gives.
std::string
errorOf(const std::string& text, const PTSOptions& options = {})
{
  const TempFolder folder;
  pcl::PCLPointCloud2 cloud;
  try {
    readPTS(folder.write("bad.pts", text), cloud, options);
  }
  catch (const LoadError& error) {
    EXPECT_TRUE(cloud.data.empty()) << "the output must be cleared";
    const std::string what = error.what();
    EXPECT_NE(what.find("bad.pts"), std::string::npos) << what;
    return what;
  }
  return "no error";
}

struct DialectCase {
  const char* name;
  const char* text;
  const char* dialect;
  std::vector<std::string> fields;
  std::size_t points;
};

class PTSDialects : public testing::TestWithParam<DialectCase> {};

TEST_P(PTSDialects, IsDetected)
{
  const DialectCase& c = GetParam();
  const TempFolder folder;
  // The same bytes with other line ends, separators and ends of file are the same
  // cloud.
  const std::string text = c.text;
  std::string crlf, tabs = text, spaced;
  for (const char ch : text) {
    crlf += ch == '\n' ? "\r\n" : std::string(1, ch);
    spaced += ch == ' ' ? "   " : ch == '\n' ? " \n" : std::string(1, ch);
  }
  std::replace(tabs.begin(), tabs.end(), ' ', '\t');
  const std::string cut = text.substr(0, text.size() - 1);
  const std::string mark = "\xef\xbb\xbf" + text;
  pcl::PCLPointCloud2 first;
  for (const std::string& variant : {text, crlf, tabs, spaced, cut, mark}) {
    pcl::PCLPointCloud2 cloud;
    const PTSReport report = readPTS(folder.write("a.pts", variant), cloud);
    EXPECT_EQ(report.dialect, c.dialect);
    EXPECT_EQ(fieldNames(cloud), c.fields);
    EXPECT_EQ(std::size_t(cloud.width) * cloud.height, c.points);
    EXPECT_EQ(cloud.data.size(), c.points * cloud.point_step);
    EXPECT_TRUE(report.warnings.empty());
    if (first.data.empty())
      first = cloud;
    EXPECT_EQ(cloud.data, first.data);
  }
}

INSTANTIATE_TEST_SUITE_P(
    All,
    PTSDialects,
    testing::Values(
        DialectCase{"LeicaXYZ", "2\n1 2 3\n4 5 6\n", "XYZ", {"x", "y", "z"}, 2},
        DialectCase{"NoCount", "1 2 3\n4 5 6\n7 8 9\n", "XYZ", {"x", "y", "z"}, 3},
        DialectCase{"XYZI",
                    "1\n1.5 -2 3e0 -2047\n",
                    "XYZI",
                    {"x", "y", "z", "intensity"},
                    1},
        DialectCase{"XYZRGB",
                    "1 2 3 255 128 0\n",
                    "XYZRGB",
                    {"x", "y", "z", "rgba"},
                    1},
        DialectCase{"XYZIRGB",
                    "1\n1 2 3 -1035 97 59 38\n",
                    "XYZIRGB",
                    {"x", "y", "z", "intensity", "rgba"},
                    1},
        // 2 x 2 pixels, seen in rows 0 and 1
        DialectCase{"Bumblebee",
                    "0.1 0.2 1.5 10 20 30 0 0\n0.2 0.2 1.5 10 20 30 0 1\n"
                    "0.1 0.3 1.5 10 20 30 1 0\n",
                    "Bumblebee",
                    {"x", "y", "z", "rgba", "v", "u"},
                    4},
        DialectCase{"CranePaper",
                    "0.1 0.2 1.5 300 0 10 20 30\n0.2 0.2 1.5 301 0 10 20 30\n"
                    "0.1 0.3 1.5 300 1 10 20 30\n",
                    "x y z u v R G B",
                    {"x", "y", "z", "u", "v", "rgba"},
                    // 302 columns lie within a quarter of no usual camera with 2 rows
                    604},
        DialectCase{
            "CloudCompare",
            "//X Y Z R G B Nx Ny Nz Reflectance\n2\n"
            "1 2 3 10 20 30 0 0 1 0.5\n1 2 4 10 20 30 0 0 1 0.25\n",
            "header",
            {"x", "y", "z", "rgba", "normal_x", "normal_y", "normal_z", "Reflectance"},
            2},
        DialectCase{"Comments",
                    "# made by hand\n\n1 2 3\n\n4 5 6\n",
                    "XYZ",
                    {"x", "y", "z"},
                    2}),
    [](const auto& test) { return test.param.name; });

TEST(PTSReader, NumbersAreRoundedExactly)
{
  // strtof is the oracle; the numbers are short, long, tiny, huge and just between two
  // floats
  std::mt19937 random(1);
  std::vector<std::string> texts = {"0",
                                    "-0.0",
                                    "16777217",      // between two floats
                                    "16777217.0001", // just above
                                    "33554433.9999999",
                                    "0.1",
                                    ".5",
                                    "5.",
                                    "+1.25",
                                    "1e-3",
                                    "1.17549435e-38",
                                    "1.4e-45",
                                    "1e-60",
                                    "3.4028235e38",
                                    "123456789012345678901234567890",
                                    "0.00000000000000000000000000012345",
                                    "636110.300003"};
  std::uniform_int_distribution<int> digit(0, 9), length(1, 12);
  for (int i = 0; i < 20000; ++i) {
    std::string text = i % 3 == 0 ? "-" : "";
    for (int k = length(random); k > 0; --k)
      text += static_cast<char>('0' + digit(random));
    text += '.';
    for (int k = length(random); k > 0; --k)
      text += static_cast<char>('0' + digit(random));
    texts.push_back(text);
  }
  // decimal expansions of points halfway between neighbouring floats
  std::uniform_real_distribution<float> range(0.5f, 100.0f);
  for (int i = 0; i < 5000; ++i) {
    const float a = range(random);
    const double middle = (double(a) + double(std::nextafter(a, 1e9f))) / 2;
    char buffer[80];
    std::snprintf(buffer, sizeof buffer, i % 2 == 0 ? "%.17g" : "%.30f", middle);
    texts.emplace_back(buffer);
  }
  std::string file;
  for (const std::string& text : texts)
    file += text + " 1 2\n";
  const TempFolder folder;
  pcl::PCLPointCloud2 cloud;
  readPTS(folder.write("n.pts", file), cloud);
  ASSERT_EQ(cloud.width, texts.size());
  for (std::size_t i = 0; i < texts.size(); ++i)
    EXPECT_EQ(value(cloud, i, 0), std::strtof(texts[i].c_str(), nullptr)) << texts[i];
}

TEST(PTSReader, LocaleDoesNotMatter)
{
  // A decimal comma everywhere: the C locale where installed, C++ by a facet of our
  // own.
  struct Comma : std::numpunct<char> {
    char
    do_decimal_point() const override
    {
      return ',';
    }
    char
    do_thousands_sep() const override
    {
      return '.';
    }
    std::string
    do_grouping() const override
    {
      return "\3";
    }
  };
  const std::string old_c = std::setlocale(LC_ALL, nullptr);
  const std::locale old = std::locale::global(std::locale(std::locale(), new Comma));
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8"})
    if (std::setlocale(LC_ALL, name) != nullptr)
      break;
  const TempFolder folder;
  pcl::PointCloud<pcl::PointXYZ> cloud;
  // 1e-1 takes the standard library's way, 1234.5 the fast one
  const std::string file = folder.write("l.pts", "1234.5 1e-1 2.25\n");
  readPTS(file, cloud);
  pcl::PCLPointCloud2 blob;
  pcl::toPCLPointCloud2(cloud, blob);
  hoist::savePTSFile(folder.name("out.pts"), blob);
  std::locale::global(old);
  std::setlocale(LC_ALL, old_c.c_str());
  ASSERT_EQ(cloud.size(), 1u);
  EXPECT_EQ(cloud[0].x, 1234.5f);
  EXPECT_EQ(cloud[0].y, 0.1f);
  EXPECT_EQ(cloud[0].z, 2.25f);
  EXPECT_EQ(hoist::test::readFile(folder.name("out.pts")), "1\n1234.5 0.1 2.25\n");
}

TEST(PTSReader, BumblebeeBecomesAGrid)
{
  const TempFolder folder;
  const std::string file =
      folder.write("b.pts",
                   "-1.2 -1.2 0.000000 175 177 175 8 8\n" // no match
                   "0.5 0.25 2.0 1 2 3 8 9\n"
                   "0.5 0.25 1.5 4 5 6 9 9\n");
  pcl::PointCloud<hoist::PointXYZRGBUV> cloud;
  const PTSReport report = readPTS(file, cloud);
  ASSERT_EQ(cloud.width, 10u);
  ASSERT_EQ(cloud.height, 10u);
  EXPECT_FALSE(cloud.is_dense);
  EXPECT_EQ(report.records, 3u);
  EXPECT_EQ(report.without_depth, 1u);
  for (unsigned v = 0; v < 10; ++v)
    for (unsigned u = 0; u < 10; ++u) {
      const auto& p = cloud(u, v);
      EXPECT_EQ(p.u, u);
      EXPECT_EQ(p.v, v);
      EXPECT_EQ(std::isfinite(p.z), (u == 9 && (v == 8 || v == 9)));
    }
  // colour stays where stereo found no depth: it belongs to the 2D image
  EXPECT_EQ(cloud(8, 8).r, 175);
  EXPECT_EQ(cloud(8, 8).g, 177);
  EXPECT_EQ(cloud(9, 8).z, 2.0f);
  EXPECT_EQ(cloud(9, 9).b, 6);

  PTSOptions options;
  options.width = 320;
  options.height = 240;
  readPTS(file, cloud, options);
  EXPECT_EQ(cloud.width, 320u);
  EXPECT_EQ(cloud.height, 240u);
  EXPECT_EQ(cloud(9, 8).z, 2.0f);

  options.width = 5;
  EXPECT_THROW(readPTS(file, cloud, options), LoadError);

  options = PTSOptions();
  options.organize = false; // then records without depth are dropped
  readPTS(file, cloud, options);
  ASSERT_EQ(cloud.size(), 2u);
  EXPECT_EQ(cloud.height, 1u);
  EXPECT_EQ(cloud[0].u, 9u);
  EXPECT_EQ(cloud[0].v, 8u);
}

TEST(PTSReader, OfSeveralRecordsOnAPixelTheNearestStays)
{
  const TempFolder folder;
  PTSOptions options;
  options.fields = "x y z r g b row col";
  const std::string near = "0 0 1 1 1 1 0 0\n", far = "0 0 2 2 2 2 0 0\n",
                    none = "0 0 0 3 3 3 0 0\n";
  for (const std::string& text :
       {near + far + none, far + none + near, none + far + near, none + near + far}) {
    pcl::PointCloud<pcl::PointXYZRGB> cloud;
    const PTSReport report = readPTS(folder.write("r.pts", text), cloud, options);
    ASSERT_EQ(cloud.size(), 1u);
    EXPECT_EQ(cloud[0].z, 1.0f) << text;
    EXPECT_EQ(cloud[0].r, 1) << text;
    EXPECT_EQ(report.repeated_pixels, 2u);
    pcl::PCLPointCloud2 blob;
    readPTS(folder.name("r.pts"), blob, options);
    EXPECT_EQ(value(blob, 0, 2), 1.0f);
    EXPECT_TRUE(blob.is_dense);
  }
}

TEST(PTSReader, FieldListOverrides)
{
  const TempFolder folder;
  const std::string file = folder.write("f.pts", "3 2 1 9 0.5\n6 5 4 9 0.25\n");
  pcl::PCLPointCloud2 cloud;
  EXPECT_THROW(readPTS(file, cloud), LoadError); // five columns mean nothing
  PTSOptions options;
  options.fields = "z y x _ curvature";
  readPTS(file, cloud, options);
  EXPECT_EQ(fieldNames(cloud), (std::vector<std::string>{"z", "y", "x", "curvature"}));
  EXPECT_EQ(value(cloud, 1, 2), 4.0f);
  EXPECT_EQ(value(cloud, 1, 3), 0.25f);
  for (const char* bad : {"x y", "x y z x q", "x y z r g", "x y z u w", "x y z a a"}) {
    options.fields = bad;
    EXPECT_THROW(readPTS(file, cloud, options), LoadError) << bad;
  }
}

TEST(PTSReader, ColorsFromZeroToOne)
{
  const TempFolder folder;
  pcl::PCLPointCloud2 cloud;
  const PTSReport report = readPTS(
      folder.write("c.pts", "//X Y Z Rf Gf Bf\n1 2 3 1.0 0.5 0\n1 2 3 0.25 0 1\n"),
      cloud);
  EXPECT_TRUE(report.unit_colors);
  EXPECT_EQ(word(cloud, 0, 3), 0xffff8000u); // 0.5 is 127.5, rounded up
  EXPECT_EQ(word(cloud, 1, 3), 0xff4000ffu);
}

TEST(PTSReader, OffsetSavesSurveyedCoordinates)
{
  const TempFolder folder;
  PTSOptions options;
  options.offset = {636000, 849000, 500};
  pcl::PCLPointCloud2 cloud;
  readPTS(folder.write("s.pts", "636110.300003 849345.050003 512.139999\n"),
          cloud,
          options);
  EXPECT_FLOAT_EQ(value(cloud, 0, 0), 110.300003f);
  EXPECT_FLOAT_EQ(value(cloud, 0, 1), 345.050003f);
  EXPECT_FLOAT_EQ(value(cloud, 0, 2), 12.139999f);
}

TEST(PTSReader, WrongCountIsSaidAndTolerated)
{
  const TempFolder folder;
  for (const char* count : {"1", "3", "999999999999"}) {
    pcl::PCLPointCloud2 cloud;
    const PTSReport report =
        readPTS(folder.write("w.pts", std::string(count) + "\n1 2 3\n4 5 6\n"), cloud);
    EXPECT_EQ(cloud.width, 2u);
    ASSERT_EQ(report.warnings.size(), 1u);
    EXPECT_NE(report.warnings[0].find(count), std::string::npos);
  }
  // several scans, each with its count
  pcl::PCLPointCloud2 cloud;
  readPTS(folder.write("m.pts", "1\n1 2 3\n2\n4 5 6\n7 8 9\n"), cloud);
  EXPECT_EQ(cloud.width, 3u);
}

TEST(PTSReader, ErrorsNameFileLineAndExpectation)
{
  const auto has = [](const std::string& text, const char* part) {
    EXPECT_NE(text.find(part), std::string::npos) << text << "\nlacks " << part;
  };
  has(errorOf(""), "empty");
  has(errorOf("\n\n"), "no points");
  has(errorOf("version: 1\nn_points: 68\n{\n1 2\n}\n"), "face landmarks");
  std::string text = errorOf("1 2 3\n4 5\n7 8 9\n");
  has(text, "bad.pts:2:");
  has(text, "expected 3 columns, found 2");
  text = errorOf("1 2 3\n4 5 6 7\n");
  has(text, ":2:");
  has(text, "found 4");
  text = errorOf("2\n1 2 3\n4 fish 6\n");
  has(text, ":3:");
  has(text, "\"fish\"");
  has(errorOf("1 2 3\n1.2.3 4 5\n"), ":2:");
  has(errorOf("1 2\n"), "expected 3, 4, 6, 7 or 8 columns");
  has(errorOf("1 2 3 4 5 6 7 8\n1 2 3 4 5 6 6 8\n"), "no Bumblebee records");
  has(errorOf(std::string(30, '1')), "count of points is absurd");
  has(errorOf(std::string(3 << 20, '1')), "line of more than");
  has(errorOf(std::string(3 << 20, ' ')), "line of more than");
  has(errorOf("1 2 3\n" + std::string(5, '\0')), "zero bytes");
  has(errorOf("1 2 3 1 1 1 4000000000 1\n"), "pixel");
  has(errorOf("1 2 3 1 1 1 30000 30000\n"), "far larger image");
  PTSOptions options;
  options.fields = "x y z r g b row col";
  has(errorOf("1 2 3 1 1 1 0.5 1\n", options), "expected a pixel number in column 7");
  has(errorOf("1 2 3 1 1 1 0 -1\n", options), "column 8");
  // control characters do not reach the terminal
  EXPECT_EQ(errorOf("1 2 \x1b[31mred\n").find('\x1b'), std::string::npos);

  const TempFolder folder;
  pcl::PCLPointCloud2 cloud;
  EXPECT_THROW(readPTS(folder.name("missing.pts"), cloud), LoadError);
  EXPECT_THROW(readPTS(folder.path().string(), cloud), LoadError);
}

TEST(PTSReader, FollowsPCLFileReader)
{
  const TempFolder folder;
  const std::string good = folder.write("g.pts", "2\n1 2 3 4\n5 6 7 8\n");
  const std::string bad = folder.write("b.pts", "1 2 3\n4 5\n");
  hoist::PTSReader reader;
  pcl::FileReader& base = reader;
  pcl::PointCloud<pcl::PointXYZI> cloud;
  ASSERT_EQ(base.read(good, cloud), 0);
  ASSERT_EQ(cloud.size(), 2u);
  EXPECT_EQ(cloud[1].intensity, 8.0f);
  EXPECT_EQ(reader.getReport().dialect, "XYZI");

  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS); // the errors are meant
  pcl::PCLPointCloud2 blob;
  EXPECT_EQ(hoist::loadPTSFile(good, blob), 0);
  EXPECT_LT(hoist::loadPTSFile(bad, blob), 0);
  EXPECT_TRUE(blob.data.empty());
  EXPECT_EQ(hoist::loadPTSFile(good, cloud), 0);
  EXPECT_LT(hoist::loadPTSFile(bad, cloud), 0);
  EXPECT_TRUE(cloud.empty());
  Eigen::Vector4f origin;
  Eigen::Quaternionf orientation;
  int version = -1, type = -1;
  unsigned index = 7;
  EXPECT_EQ(reader.readHeader(good, blob, origin, orientation, version, type, index),
            0);
  EXPECT_EQ(blob.width, 2u);
  EXPECT_TRUE(blob.data.empty());
  EXPECT_LT(reader.readHeader(
                folder.name("none"), blob, origin, orientation, version, type, index),
            0);
  pcl::console::setVerbosityLevel(pcl::console::L_INFO);
}

TEST(PTSWriter, OrganizedCloudComesBackBitForBit)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<float> coordinate(-3, 3), depth(0.3f, 9);
  pcl::PointCloud<pcl::PointXYZRGBA> cloud(64, 48);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    auto& p = cloud[i];
    p.rgba = 0xff000000u | (random() & 0xffffffu);
    if (i % 5 == 0) {
      p.x = p.y = p.z = std::numeric_limits<float>::quiet_NaN();
      continue;
    }
    p.x = coordinate(random);
    p.y = coordinate(random) * 1e-4f;
    p.z = depth(random);
  }
  const TempFolder folder;
  ASSERT_EQ(hoist::savePTSFile(folder.name("o.pts"), cloud), 0);
  pcl::PointCloud<pcl::PointXYZRGBA> back;
  const PTSReport report = readPTS(folder.name("o.pts"), back);
  EXPECT_EQ(report.dialect, "Bumblebee");
  ASSERT_EQ(back.width, cloud.width);
  ASSERT_EQ(back.height, cloud.height);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_EQ(back[i].rgba, cloud[i].rgba);
    EXPECT_EQ(std::isfinite(back[i].z), std::isfinite(cloud[i].z));
    if (std::isfinite(cloud[i].z)) {
      EXPECT_EQ(back[i].getVector3fMap(), cloud[i].getVector3fMap());
    }
  }

  // six decimals, as the camera's software writes: half a micrometre
  hoist::PTSWriter writer;
  writer.setDecimals(6);
  writer.setWriteInvalid(false);
  pcl::PCLPointCloud2 blob;
  pcl::toPCLPointCloud2(cloud, blob);
  ASSERT_EQ(writer.write(folder.name("six.pts"), blob), 0);
  readPTS(folder.name("six.pts"), back);
  ASSERT_EQ(back.size(), cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (std::isfinite(cloud[i].z)) {
      EXPECT_NEAR(back[i].y, cloud[i].y, 0.51e-6);
    }
}

TEST(PTSWriter, DialectsFollowTheFields)
{
  const TempFolder folder;
  const auto dialectOf = [&](const auto& cloud, hoist::PTSDialect dialect) {
    pcl::PCLPointCloud2 blob, back;
    pcl::toPCLPointCloud2(cloud, blob);
    hoist::PTSWriter writer;
    writer.setDialect(dialect);
    EXPECT_EQ(writer.write(folder.name("d.pts"), blob), 0);
    const PTSReport report = readPTS(folder.name("d.pts"), back);
    EXPECT_EQ(back.width * back.height, cloud.size());
    EXPECT_TRUE(report.warnings.empty());
    return report.dialect;
  };
  using hoist::PTSDialect;
  const auto automatic = PTSDialect::automatic;
  EXPECT_EQ(dialectOf(pcl::PointCloud<pcl::PointXYZ>(3, 1), automatic), "XYZ");
  EXPECT_EQ(dialectOf(pcl::PointCloud<pcl::PointXYZI>(3, 1), automatic), "XYZI");
  EXPECT_EQ(dialectOf(pcl::PointCloud<pcl::PointXYZRGB>(3, 1), automatic), "XYZRGB");
  EXPECT_EQ(dialectOf(pcl::PointCloud<pcl::PointXYZRGB>(3, 1), PTSDialect::xyzirgb),
            "XYZIRGB");
  EXPECT_EQ(dialectOf(pcl::PointCloud<pcl::PointXYZRGB>(3, 2), automatic), "Bumblebee");
  pcl::PointCloud<hoist::PointXYZRGBUV> record(1, 1);
  record[0].z = 1;
  EXPECT_EQ(dialectOf(record, automatic), "Bumblebee");
}

TEST(PTSWriter, FailuresLeaveNoFile)
{
  const TempFolder folder;
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  pcl::PCLPointCloud2 blob;
  EXPECT_LT(hoist::savePTSFile(folder.name("e.pts"), blob), 0); // no x y z
  pcl::PointCloud<pcl::PointXYZ> cloud(3, 1);
  pcl::toPCLPointCloud2(cloud, blob);
  hoist::PTSWriter writer;
  writer.setDialect(hoist::PTSDialect::bumblebee);
  EXPECT_LT(writer.write(folder.name("e.pts"), blob), 0); // no pixels
  EXPECT_LT(hoist::savePTSFile(folder.name("no/such/folder.pts"), cloud), 0);
  blob.data.resize(5);
  EXPECT_LT(hoist::savePTSFile(folder.name("e.pts"), blob), 0);
  pcl::console::setVerbosityLevel(pcl::console::L_INFO);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(PTSReader, MemoryBeyondTheCloudIsBounded)
{
  if (!hoist::test::memory_is_measurable)
    GTEST_SKIP() << "a sanitizer keeps memory of its own";
  // 1.2 million records, 50 MB of text: a reader that keeps the text would show.
  const TempFolder folder;
  const std::string file = folder.name("big.pts");
  {
    std::ofstream out(file, std::ios::binary);
    std::string block;
    for (int v = 0; v < 960; ++v) {
      block.clear();
      for (int u = 0; u < 1280; ++u)
        block += "0.123456 0.234567 1.345678 100 101 102 " + std::to_string(v) + " " +
                 std::to_string(u) + "\n";
      out << block;
    }
  }
  const auto peak = [] { // [KiB]
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
  };
  for (const bool organize : {true, false}) {
    const long before = peak();
    pcl::PCLPointCloud2 cloud;
    PTSOptions options;
    options.organize = organize;
    readPTS(file, cloud, options);
    const long cloud_kib = static_cast<long>(cloud.data.size() / 1024);
    ASSERT_EQ(cloud.width * cloud.height, 1280u * 960u);
    EXPECT_LT(peak() - before, cloud_kib + 32 * 1024);
  }
}

TEST(PTSRealData, EveryWritersFileIsRead)
{
  HOIST_SKIP_WITHOUT_REAL_DATA();
  const auto folder = *hoist::test::realData() / "pts";
  const std::vector<std::tuple<const char*, const char*, std::size_t>> files = {
      {"pdal_autzen.pts", "XYZIRGB", 10},
      {"pdal_bunny_8.pts", "XYZ", 9}, // its count line says 8
      {"pdal_site_56_8.pts", "XYZI", 8},
      {"pdal_test.pts", "XYZIRGB", 19}};
  for (const auto& [name, dialect, points] : files) {
    pcl::PCLPointCloud2 cloud;
    const PTSReport report = readPTS((folder / name).string(), cloud);
    EXPECT_EQ(report.dialect, dialect) << name;
    EXPECT_EQ(cloud.width, points) << name;
    EXPECT_EQ(report.warnings.empty(), report.declared == points) << name;
  }
  pcl::PCLPointCloud2 cloud;
  const PTSReport report = readPTS((folder / "triclops_excerpt.pts").string(), cloud);
  EXPECT_EQ(report.dialect, "Bumblebee");
  EXPECT_EQ(report.records, 38u);
  EXPECT_EQ(report.without_depth, 7u); // the runs of z = 0
  // rows up to 161 and columns up to 295: the excerpt's extent
  EXPECT_GT(cloud.height, 1u);
}

} // namespace
