// Files that are damaged or made to do harm: each ends in a LoadError that names it.
// All cases on which PCL 1.13's reader crashes, hangs, or invents points are here.
#include "support/sanitizers.h"
#include "temp_folder.h"

#include <hoist/data/load_frame.h>
#include <hoist/data/pts_io.h>

#include <gtest/gtest.h>

#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <random>

namespace {

using hoist::LoadError;
using hoist::loadFrame;
using hoist::test::TempFolder;

long
peakKiB()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

std::string
bytesOf(std::initializer_list<std::uint32_t> words)
{
  std::string out;
  for (const std::uint32_t w : words)
    out.append(reinterpret_cast<const char*>(&w), 4);
  return out;
}

// A PCD header with one line replaced or left out.
std::string
pcd(const std::string& data,
    const std::string& key = "",
    const std::string& line = "",
    const std::string& body = "")
{
  const std::pair<const char*, std::string> lines[] = {
      {"VERSION", "VERSION 0.7"},
      {"FIELDS", "FIELDS x y z"},
      {"SIZE", "SIZE 4 4 4"},
      {"TYPE", "TYPE F F F"},
      {"COUNT", "COUNT 1 1 1"},
      {"WIDTH", "WIDTH 2"},
      {"HEIGHT", "HEIGHT 2"},
      {"VIEWPOINT", "VIEWPOINT 0 0 0 1 0 0 0"},
      {"POINTS", "POINTS 4"},
      {"DATA", "DATA " + data}};
  std::string out;
  for (const auto& [name, text] : lines)
    if (key != name)
      out += text + '\n';
    else if (!line.empty())
      out += line + '\n';
  return out + body;
}

std::string
ply(const std::string& header, const std::string& body)
{
  return "ply\nformat ascii 1.0\n" + header +
         "property float x\nproperty float y\nproperty float z\nend_header\n" + body;
}

struct Hostile {
  const char* name;
  const char* file;
  std::string bytes;
  const char* says; // part of the message
};

std::vector<Hostile>
hostileFiles()
{
  const std::string zeros(48, '\0');
  std::string names = "FIELDS x y z";
  for (int i = 0; i < 5000000; ++i)
    names += " f";
  return {
      {"Empty", "a.pcd", "", "empty"},
      {"EmptyPly", "a.ply", "", "empty"},
      {"EmptyPts", "a.pts", "", "empty"},
      {"AllZeroBytes", "a.pcd", std::string(4096, '\0'), "header ends"},
      {"AllZeroBytesLong", "a.pcd", std::string(1 << 20, '\0'), "no DATA line"},
      {"CompressedZeroSizes",
       "a.pcd",
       pcd("binary_compressed", "", "", bytesOf({0, 0})),
       "uncompressed size 0"},
      {"FiveMillionFields", "a.pcd", pcd("ascii", "FIELDS", names), "no DATA line"},
      {"ManyFields",
       "a.pcd",
       pcd("ascii", "FIELDS", names.substr(0, 2000)),
       "field names"},
      {"HugeWidth",
       "a.pcd",
       pcd("binary", "WIDTH", "WIDTH 4294967295", zeros),
       "POINTS"},
      {"HugeWidthAndPoints",
       "a.pcd",
       "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 4000000000\nHEIGHT 1\nDATA "
       "binary\n",
       "more than"},
      {"OverflowingSize",
       "a.pcd",
       "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 4294967296\nHEIGHT "
       "4294967296\nDATA binary\n",
       "absurd"},
      {"NegativeWidth",
       "a.pcd",
       pcd("binary", "WIDTH", "WIDTH -2", zeros),
       "whole number"},
      {"NegativeCount",
       "a.pcd",
       pcd("binary", "COUNT", "COUNT 1 1 -1", zeros),
       "whole number"},
      {"ZeroCount", "a.pcd", pcd("binary", "COUNT", "COUNT 1 1 0", zeros), "COUNT"},
      {"HugeCount",
       "a.pcd",
       pcd("binary", "COUNT", "COUNT 1 1 4294967295", zeros),
       "COUNT"},
      {"CompressedBomb",
       "a.pcd",
       "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 8000\nHEIGHT 8000\nDATA "
       "binary_compressed\n" +
           bytesOf({8, 768000000, 0, 0}),
       "cannot hold"},
      {"CompressedPromise",
       "a.pcd",
       pcd("binary_compressed", "", "", bytesOf({4000000000u, 48, 0})),
       "promised"},
      {"CompressedDamaged",
       "a.pcd",
       pcd("binary_compressed", "", "", bytesOf({8, 48, 0xffffffffu, 0xffffffffu})),
       "damaged"},
      {"CompressedCut", "a.pcd", pcd("binary_compressed", "", "", "abc"), "cut"},
      {"HugeAsciiPoints",
       "a.pcd",
       "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 60000000\nHEIGHT 1\nPOINTS "
       "60000000\nDATA ascii\n1 2 3\n",
       "promises"},
      {"AsciiJunk",
       "a.pcd",
       pcd("ascii", "", "", "1 2 3\n4 5 6\nfoo bar baz\n1 2 3\n"),
       "\"foo\""},
      {"AsciiHalfNumber",
       "a.pcd",
       pcd("ascii", "", "", "1 2 3\n4 5x 6\n1 2 3\n1 2 3\n"),
       ":12:"},
      {"AsciiTooFewNumbers",
       "a.pcd",
       pcd("ascii", "", "", "1 2 3\n4 5\n1 2 3\n1 2 3\n"),
       "expected a number"},
      {"AsciiTooManyNumbers",
       "a.pcd",
       pcd("ascii", "", "", "1 2 3\n4 5 6 7\n1 2 3\n1 2 3\n"),
       "more numbers"},
      {"AsciiTooFewPoints",
       "a.pcd",
       pcd("ascii", "", "", "1 2 3\n1 2 3\n1 2 3\n"),
       "holds 3"},
      {"AsciiTooManyPoints",
       "a.pcd",
       pcd("ascii", "", "", "1 2 3\n1 2 3\n1 2 3\n1 2 3\n1 2 3\n"),
       "more than"},
      {"SizeThree", "a.pcd", pcd("binary", "SIZE", "SIZE 4 4 3", zeros), "SIZE"},
      {"FloatOfTwoBytes",
       "a.pcd",
       pcd("binary", "SIZE", "SIZE 4 4 2", zeros),
       "float of 2"},
      {"UnknownType", "a.pcd", pcd("binary", "TYPE", "TYPE F F D", zeros), "TYPE"},
      {"SizeBeforeFields", "a.pcd", "SIZE 4 4 4\n", "before FIELDS"},
      {"TwoFieldsLines", "a.pcd", "FIELDS x y z\nFIELDS a\n", "second FIELDS"},
      {"FewerTypes", "a.pcd", pcd("binary", "TYPE", "TYPE F F", zeros), "entries"},
      {"NoFields", "a.pcd", pcd("binary", "FIELDS", "# none", zeros), "before FIELDS"},
      {"NoData", "a.pcd", pcd("binary", "DATA", "# none"), "before its DATA"},
      {"UnknownData", "a.pcd", pcd("zip"), "expected DATA"},
      {"UnknownLine", "a.pcd", pcd("binary", "VERSION", "HELLO 1"), "\"HELLO\""},
      {"NoZ", "a.pcd", pcd("binary", "FIELDS", "FIELDS x y q", zeros), "no field z"},
      {"TwoX", "a.pcd", pcd("binary", "FIELDS", "FIELDS x x z", zeros), "one field x"},
      {"BadViewpoint",
       "a.pcd",
       pcd("binary", "VIEWPOINT", "VIEWPOINT 0 0 0 a 0 0 0", zeros),
       "VIEWPOINT"},
      {"BinaryCut", "a.pcd", pcd("binary", "", "", zeros.substr(1)), "promises"},
      {"NoPoints",
       "a.pcd",
       "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 0\nHEIGHT 0\nDATA ascii\n",
       "no points"},
      {"PixelOutOfWorld",
       "a.pcd",
       "FIELDS x y z u v\nSIZE 4 4 4 4 4\nTYPE F F F U U\nWIDTH 1\nHEIGHT 1\nDATA "
       "ascii\n1 1 1 4000000000 4000000000\n",
       "image"},
      {"PlyNoPly", "a.ply", "pl\n", "expected \"ply\""},
      {"PlyHugeCount",
       "a.ply",
       ply("element vertex 50000000\n", "1 2 3\n"),
       "promises"},
      {"PlyAbsurdCount",
       "a.ply",
       ply("element vertex 18446744073709551615\n", "1 2 3\n"),
       "more than"},
      {"PlyOverflow",
       "a.ply",
       ply("element vertex 99999999999999999999999\n", "1 2 3\n"),
       "whole number"},
      {"PlyJunk", "a.ply", ply("element vertex 1\n", "1 fish 3\n"), "\"fish\""},
      {"PlyCut", "a.ply", ply("element vertex 2\n", "1 2 3\n"), "in the midst"},
      {"PlyEndlessElement",
       "a.ply",
       "ply\nformat ascii 1.0\nelement nothing 18446744073709551615\n"
       "element vertex 1\nproperty float x\nproperty float y\nend_header\n1 2\n",
       "no field z"},
      {"PlyListBefore",
       "a.ply",
       "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int f\n"
       "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
       "end_header\n1 1\n1 2 3\n",
       "before the points"},
      {"PlyNoEnd", "a.ply", "ply\nformat ascii 1.0\n", "end_header"},
      {"PlyNoFormat", "a.ply", "ply\nend_header\n", "no format"},
      {"PlyBadType",
       "a.ply",
       "ply\nformat ascii 1.0\nelement vertex 1\nproperty q x\n",
       "number type"},
      {"PtsZeroBytes", "a.pts", "1 2 3\n" + std::string(4096, '\0'), "zero bytes"},
      {"PtsHugePixel", "a.pts", "1 2 3 1 1 1 30000 30000\n", "far larger"},
      {"PtsHugeCount", "a.pts", "999999999999999999\n1 2 3\n", "intrinsics"},
      {"Landmarks", "a.pts", "version: 1\nn_points: 1\n{\n1 2\n}\n", "landmarks"},
      {"UnknownEnding", "a.doc", "1 2 3\n", "name that ends"},
  };
}

class HostileFiles : public testing::TestWithParam<Hostile> {};

TEST_P(HostileFiles, EndInAnErrorThatNamesFileAndCause)
{
  const TempFolder folder;
  const std::string file = folder.write(GetParam().file, GetParam().bytes);
  const long before = peakKiB();
  const auto start = std::chrono::steady_clock::now();
  try {
    (void)loadFrame(file);
    ADD_FAILURE() << "was read";
  }
  catch (const LoadError& error) {
    const std::string what = error.what();
    EXPECT_EQ(what.rfind(file, 0), 0u) << what;
    EXPECT_NE(what.find(GetParam().says), std::string::npos) << what;
    EXPECT_LT(what.size(), 600u);
    for (const char c : what)
      EXPECT_GE(static_cast<unsigned char>(c), 32) << "control characters in " << what;
  }
  if (hoist::test::memory_is_measurable) {
    EXPECT_LT(peakKiB() - before, 64 * 1024);
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

INSTANTIATE_TEST_SUITE_P(All,
                         HostileFiles,
                         testing::ValuesIn(hostileFiles()),
                         [](const auto& test) { return test.param.name; });

TEST(HostileNames, MissingFilesFoldersAndUnreadableOnes)
{
  const TempFolder folder;
  for (const char* name : {"none.pcd", "none.pts", "none.ply", "no/folder.pcd", ""})
    EXPECT_THROW((void)loadFrame(folder.name(name)), LoadError) << name;
  std::filesystem::create_directory(folder.path() / "d.pcd");
  EXPECT_THROW((void)loadFrame(folder.name("d.pcd")), LoadError);
}

// Small valid files of every format.
std::vector<std::pair<std::string, std::string>>
smallFiles()
{
  const TempFolder folder;
  pcl::PointCloud<pcl::PointXYZRGB> cloud(4, 3);
  for (int i = 0; i < 12; ++i) {
    cloud[i].x = 0.1f * static_cast<float>(i % 4);
    cloud[i].y = 0.1f * static_cast<float>(i) / 4;
    cloud[i].z = 1;
    cloud[i].rgba = 0xff102030u;
  }
  pcl::PCDWriter pcd_writer;
  pcd_writer.writeASCII(folder.name("a.pcd"), cloud);
  pcd_writer.writeBinary(folder.name("b.pcd"), cloud);
  pcd_writer.writeBinaryCompressed(folder.name("c.pcd"), cloud);
  pcl::PLYWriter ply_writer;
  ply_writer.write(folder.name("b.ply"), cloud, true, true);
  ply_writer.write(folder.name("a.ply"), cloud, false, true);
  hoist::savePTSFile(folder.name("b.pts"), cloud);
  std::vector<std::pair<std::string, std::string>> files;
  for (const char* name : {"a.pcd", "b.pcd", "c.pcd", "a.ply", "b.ply", "b.pts"})
    files.emplace_back(name, hoist::test::readFile(folder.path() / name));
  files.emplace_back("x.pts",
                     "2\n1 2 3 -1035 97 59 38\n-25.05 -2.6 -0.12 -1 32 19 11\n");
  return files;
}

// A frame, or an error: nothing else may come of a file.
bool
loads(const std::string& file)
{
  try {
    const auto frame = loadFrame(file);
    EXPECT_EQ(frame.cloud->size(), frame.cloud->width * frame.cloud->height);
    EXPECT_GT(frame.cloud->height, 1u);
    return true;
  }
  catch (const LoadError& error) {
    EXPECT_FALSE(error.reason().empty());
    return false;
  }
}

TEST(HostileFiles, TruncatedAtEveryByte)
{
  const TempFolder folder;
  for (const auto& [name, bytes] : smallFiles()) {
    SCOPED_TRACE(name);
    const bool lone = name == "x.pts"; // no Kinect's pixels: refused whole as well
    EXPECT_EQ(loads(folder.write(name, bytes)), !lone);
    std::size_t read = 0;
    for (std::size_t n = 0; n < bytes.size(); ++n)
      read += loads(folder.write(name, bytes.substr(0, n))) ? 1 : 0;
    // Binary data is complete or refused. Text may lose its last digits, and a PTS
    // file, which does not say how long it is, its last lines.
    if (name == "b.pcd" || name == "c.pcd" || name == "b.ply") {
      EXPECT_EQ(read, 0u);
    }
    else {
      EXPECT_LT(read, bytes.size() / 2);
    }
  }
}

TEST(HostileFiles, RandomMutations)
{
  // Seeded, so that a failure comes back; bounded in number, so that it takes seconds.
  const TempFolder folder;
  std::mt19937 random(20260101);
  const auto files = smallFiles();
  std::size_t read = 0, refused = 0;
  const long before = peakKiB();
  for (int round = 0; round < 4000; ++round) {
    auto [name, bytes] = files[round % files.size()];
    for (int changes = 1 + static_cast<int>(random() % 4); changes > 0; --changes) {
      const std::size_t at = random() % bytes.size();
      switch (random() % 5) {
      case 0:
        bytes[at] = static_cast<char>(random());
        break;
      case 1:
        bytes[at] ^= static_cast<char>(1 << random() % 8);
        break;
      case 2:
        bytes.insert(at, std::to_string(random()));
        break;
      case 3:
        bytes.erase(at, 1 + random() % 20);
        break;
      default: // a digit for a digit: keeps more files readable
        if (bytes[at] >= '0' && bytes[at] <= '9')
          bytes[at] = static_cast<char>('0' + random() % 10);
      }
      if (bytes.empty())
        bytes = "x";
    }
    (loads(folder.write(name, bytes)) ? read : refused) += 1;
  }
  EXPECT_GT(read, 100u); // both happen, or the test tests nothing
  EXPECT_GT(refused, 100u);
  if (hoist::test::memory_is_measurable) {
    EXPECT_LT(peakKiB() - before, 256 * 1024);
  }
}

} // namespace
