#include <hoist/simulation/write_frame.h>

#include <hoist/data/atomic_file.h>
#include <hoist/data/pts_io.h>

#include <opencv2/imgcodecs.hpp>

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hoist {
namespace simulation {
namespace {

namespace fs = std::filesystem;

constexpr double depth_unit = 0.00025; // [m]: 16 bits reach 16 m
constexpr int jpeg_quality = 92;

fs::path
named(const fs::path& stem, const char* ending)
{
  fs::path path = stem;
  path += ending;
  return path;
}

std::uint64_t
writeImage(const fs::path& path, const cv::Mat& image, const std::vector<int>& settings)
{
  std::vector<unsigned char> bytes;
  if (!cv::imencode(path.extension().string(), image, bytes, settings))
    throw pcl::IOException(path.string() + ": cannot be encoded");
  writeFileAtomically(
      path,
      std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  return bytes.size();
}

cv::Mat1w
packedDepth(const cv::Mat1f& depth)
{
  cv::Mat1w packed(depth.size());
  std::transform(depth.begin(), depth.end(), packed.begin(), [](float z) {
    const double units = std::floor(z / depth_unit + 0.5);
    return static_cast<std::uint16_t>(units >= 1 && units <= 65535 ? units : 0);
  });
  return packed;
}

pcl::PointCloud<pcl::PointXYZRGBA>
cloudOf(const Frame& frame)
{
  pcl::PointCloud<pcl::PointXYZRGBA> cloud(
      static_cast<std::uint32_t>(frame.depth.cols),
      static_cast<std::uint32_t>(frame.depth.rows));
  cloud.is_dense = true;
  for (int v = 0; v < frame.depth.rows; ++v)
    for (int u = 0; u < frame.depth.cols; ++u) {
      pcl::PointXYZRGBA& point = cloud(u, v);
      const double z = frame.depth(v, u);
      if (std::isfinite(z)) {
        const Eigen::Vector3d p = z * frame.camera.ray(u, v);
        point.x = static_cast<float>(p.x());
        point.y = static_cast<float>(p.y());
        point.z = static_cast<float>(z);
      }
      else {
        point.x = point.y = point.z = std::numeric_limits<float>::quiet_NaN();
        cloud.is_dense = false;
      }
      const cv::Vec3b& bgr = frame.color(v, u);
      point.b = bgr[0];
      point.g = bgr[1];
      point.r = bgr[2];
      point.a = 255;
    }
  cloud.sensor_origin_.head<3>() = frame.pose.translation().cast<float>();
  cloud.sensor_orientation_ = Eigen::Quaterniond(frame.pose.linear()).cast<float>();
  return cloud;
}

// PCL's writers want a name and only say that they failed.
template <typename Writer>
std::uint64_t
writeCloud(const fs::path& path, Writer writer)
{
  AtomicFile file(path);
  if (writer(file.temporary().string()) < 0)
    throw pcl::IOException(path.string() + ": cannot be written");
  const std::uint64_t size = fs::file_size(file.temporary());
  file.commit();
  return size;
}

} // namespace

std::vector<fs::path>
frameFiles(const fs::path& stem, const std::vector<FrameFormat>& formats)
{
  std::vector<fs::path> files;
  for (const FrameFormat format : formats)
    switch (format) {
    case FrameFormat::pcd:
      files.push_back(named(stem, ".pcd"));
      break;
    case FrameFormat::pts:
      files.push_back(named(stem, ".pts"));
      break;
    case FrameFormat::compact:
      files.push_back(named(stem, ".jpg"));
      files.push_back(named(stem, ".depth.png"));
      break;
    }
  files.push_back(named(stem, ".instances.png"));
  files.push_back(named(stem, ".json"));
  return files;
}

std::uint64_t
writeFrame(const Frame& frame,
           const fs::path& stem,
           const std::vector<FrameFormat>& formats)
{
  FrameAnnotation truth = frame.truth;
  std::uint64_t bytes = 0;
  const auto has = [&](FrameFormat format) {
    return std::find(formats.begin(), formats.end(), format) != formats.end();
  };
  if (has(FrameFormat::compact)) {
    const fs::path color = named(stem, ".jpg"), depth = named(stem, ".depth.png");
    bytes += writeImage(color, frame.color, {cv::IMWRITE_JPEG_QUALITY, jpeg_quality});
    bytes +=
        writeImage(depth, packedDepth(frame.depth), {cv::IMWRITE_PNG_COMPRESSION, 3});
    truth.files.color = color.filename().string();
    truth.files.depth = depth.filename().string();
    truth.depth_scale = depth_unit;
  }
  if (has(FrameFormat::pcd) || has(FrameFormat::pts)) {
    const auto cloud = cloudOf(frame);
    if (has(FrameFormat::pts)) {
      pcl::PCLPointCloud2 blob;
      pcl::toPCLPointCloud2(cloud, blob);
      const fs::path path = named(stem, ".pts");
      PTSWriter writer;
      writer.setDialect(PTSDialect::bumblebee);
      writer.setDecimals(6); // as the camera's own software
      bytes += writeCloud(
          path, [&](const std::string& name) { return writer.write(name, blob); });
      truth.files.cloud = path.filename().string();
    }
    if (has(FrameFormat::pcd)) {
      const fs::path path = named(stem, ".pcd");
      bytes += writeCloud(path, [&](const std::string& name) {
        return pcl::PCDWriter().writeBinaryCompressed(name, cloud);
      });
      truth.files.cloud = path.filename().string();
    }
  }
  const fs::path instances = named(stem, ".instances.png");
  bytes += writeImage(instances, frame.instances, {cv::IMWRITE_PNG_COMPRESSION, 3});
  truth.files.instances = instances.filename().string();
  const std::string text = toJson(truth) + "\n";
  writeFileAtomically(named(stem, ".json"), text);
  return bytes + text.size();
}

} // namespace simulation
} // namespace hoist
