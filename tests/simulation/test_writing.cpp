// The same bytes from any number of threads, and files that say what the frame says.
#include "simulated.h"

#include "data/temp_folder.h"
#include <hoist/data/load_frame.h>
#include <hoist/simulation/suites.h>
#include <hoist/simulation/write_frame.h>

#include <opencv2/imgcodecs.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <thread>

namespace hoist {
namespace test {
namespace {

using simulation::Frame;
using simulation::FrameFormat;

const char* const small = R"(
sensor: {kind: KIND, width: 160, height: 120, fx: 140}
camera: {distance: [2, 4]}
area: [3, 3]
light: {lamps: 2}
things:
  - {kind: [carton, block, chair, plant, bucket, worker], count: 8, stacked: 0.3, timbers: 0.4}
)";

simulation::Description
smallDescription(const std::string& kind)
{
  std::string yaml = small;
  yaml.replace(yaml.find("KIND"), 4, kind);
  return simulation::parseDescription(yaml, "small.yaml");
}

bool
sameBytes(const cv::Mat& a, const cv::Mat& b)
{
  if (a.size() != b.size() || a.type() != b.type())
    return false;
  for (int row = 0; row < a.rows; ++row)
    if (std::memcmp(a.ptr(row), b.ptr(row), a.cols * a.elemSize()) != 0)
      return false;
  return true;
}

TEST(Simulate, SameBytesAtAnyNumberOfThreads)
{
  for (const char* kind : {"ideal", "kinect", "tof", "stereo"}) {
    SCOPED_TRACE(kind);
    const simulation::Description description = smallDescription(kind);
    constexpr int count = 4;
    std::vector<Frame> alone(count), together(count);
    const auto make = [&](int number, Frame& frame) {
      frame = simulation::simulate(simulation::makeScene(description, 9, number));
    };
    for (int i = 0; i < count; ++i)
      make(i, alone[static_cast<std::size_t>(i)]);
    std::vector<std::thread> threads;
    for (int i = 0; i < count; ++i)
      threads.emplace_back([&, i] { make(i, together[static_cast<std::size_t>(i)]); });
    for (std::thread& thread : threads)
      thread.join();
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_TRUE(sameBytes(alone[i].color, together[i].color));
      EXPECT_TRUE(sameBytes(alone[i].depth, together[i].depth));
      EXPECT_TRUE(sameBytes(alone[i].instances, together[i].instances));
      EXPECT_EQ(toJson(alone[i].truth), toJson(together[i].truth));
      if (i > 0) { // frames differ from each other
        EXPECT_FALSE(sameBytes(alone[i].color, alone[0].color));
      }
    }
  }
}

TEST(WriteFrame, FilesHoldTheFrame)
{
  const TempFolder folder;
  const Frame frame =
      simulation::simulate(simulation::makeScene(smallDescription("kinect"), 9, 0));
  ASSERT_FALSE(frame.truth.objects.empty());
  const auto stem = folder.path() / "a";
  const std::uint64_t bytes = writeFrame(
      frame, stem, {FrameFormat::pcd, FrameFormat::pts, FrameFormat::compact});
  std::uint64_t on_disk = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    on_disk += entry.file_size();
  EXPECT_EQ(bytes, on_disk);

  const FrameAnnotation truth = loadAnnotation(folder.path() / "a.json");
  EXPECT_EQ(truth.objects.size(), frame.truth.objects.size());
  EXPECT_EQ(truth.files.cloud, "a.pcd");
  EXPECT_TRUE(truth.pose.has_value());
  const cv::Mat1w depth =
      cv::imread((folder.path() / truth.files.depth).string(), cv::IMREAD_UNCHANGED);
  const cv::Mat1w instances = cv::imread(
      (folder.path() / truth.files.instances).string(), cv::IMREAD_UNCHANGED);
  const cv::Mat color = cv::imread((folder.path() / truth.files.color).string());
  ASSERT_EQ(depth.size(), frame.depth.size());
  EXPECT_TRUE(sameBytes(instances, frame.instances));
  EXPECT_EQ(color.size(), frame.color.size());
  const LoadedFrame pcd = loadFrame(folder.name("a.pcd"));
  const LoadedFrame pts = loadFrame(folder.name("a.pts"));
  ASSERT_EQ(pcd.cloud->width, 160U);
  ASSERT_EQ(pts.cloud->width, 160U);
  ASSERT_EQ(pts.cloud->height, 120U);
  for (int v = 0; v < 120; ++v)
    for (int u = 0; u < 160; ++u) {
      const float z = frame.depth(v, u);
      const auto &p = (*pcd.cloud)(u, v), &q = (*pts.cloud)(u, v);
      if (!std::isfinite(z)) {
        EXPECT_EQ(depth(v, u), 0);
        EXPECT_FALSE(std::isfinite(p.z));
        EXPECT_FALSE(std::isfinite(q.z));
        continue;
      }
      EXPECT_NEAR(depth(v, u) * *truth.depth_scale, z, *truth.depth_scale / 2 + 1e-7);
      EXPECT_EQ(p.z, z);
      EXPECT_NEAR(q.z, z, 1e-6); // six decimals
      EXPECT_NEAR((u - 79.5) / 140 * z, p.x, 1e-6);
      EXPECT_EQ(p.b, frame.color(v, u)[0]);
      EXPECT_EQ(p.r, frame.color(v, u)[2]);
    }
}

TEST(WriteFrame, FolderThatIsNoneIsSaid)
{
  const TempFolder folder;
  const std::string file = folder.write("file", "x");
  const Frame frame =
      simulation::simulate(simulation::makeScene(smallDescription("ideal"), 9, 0));
  EXPECT_THROW(writeFrame(frame, file + "/a", {FrameFormat::pcd}), pcl::IOException);
}

} // namespace
} // namespace test
} // namespace hoist
