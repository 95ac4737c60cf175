// From points to an organized frame.
#include "raw_cloud.h"

#include <hoist/data/estimate_intrinsics.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hoist {
namespace detail {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr int max_side = 1 << 15;
constexpr std::uint64_t free_cells = std::uint64_t(1) << 21;
constexpr std::uint64_t cells_per_record = 32;

bool
measured(const Record& r)
{
  return std::isfinite(r.x) && std::isfinite(r.y) && std::isfinite(r.z) && r.z > 0;
}

void
fill(pcl::PointXYZRGB& point, const Record& record)
{
  if (measured(record)) {
    point.x = record.x;
    point.y = record.y;
    point.z = record.z;
  }
  else
    point.x = point.y = point.z = nan;
  point.rgba = record.color;
}

// An empty grid of that size, if the file's records justify it.
void
prepare(const std::string& file,
        std::int64_t width,
        std::int64_t height,
        std::size_t records,
        pcl::PointCloud<pcl::PointXYZRGB>& cloud)
{
  if (width < 1 || height < 2 || width > max_side || height > max_side ||
      static_cast<std::uint64_t>(width * height) >
          std::max<std::uint64_t>(free_cells, cells_per_record * records))
    throw LoadError(file,
                    "",
                    "an image of " + std::to_string(width) + " x " +
                        std::to_string(height) + " pixels does not fit " +
                        std::to_string(records) + " points");
  pcl::PointXYZRGB blank;
  blank.x = blank.y = blank.z = nan;
  blank.rgba = 0xff000000u;
  cloud.resize(
      static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), blank);
}

// Puts a record on its pixel; of several the nearest stays.
void
place(pcl::PointCloud<pcl::PointXYZRGB>& cloud,
      std::uint32_t u,
      std::uint32_t v,
      const Record& record)
{
  pcl::PointXYZRGB& point = cloud[static_cast<std::size_t>(v) * cloud.width + u];
  if (std::isfinite(point.z) && !(measured(record) && record.z < point.z))
    return;
  fill(point, record);
}

void
placeByPixels(const std::string& file,
              const RawCloud& raw,
              const LoadOptions& options,
              pcl::PointCloud<pcl::PointXYZRGB>& cloud)
{
  std::uint32_t max_u = 0, max_v = 0;
  for (const Record& r : raw.records) {
    max_u = std::max(max_u, r.u);
    max_v = std::max(max_v, r.v);
  }
  const std::int64_t width =
      options.width > 0 ? options.width : std::int64_t(max_u) + 1;
  const std::int64_t height =
      options.height > 0 ? options.height : std::int64_t(max_v) + 1;
  if (max_u >= width || max_v >= height)
    throw LoadError(file,
                    "",
                    "the fields u and v name a pixel outside the image of " +
                        std::to_string(width) + " x " + std::to_string(height));
  prepare(file, width, height, raw.records.size(), cloud);
  for (const Record& r : raw.records)
    place(cloud, r.u, r.v, r);
}

Intrinsics
kinect()
{
  Intrinsics camera;
  camera.fx = camera.fy = 525.0;
  camera.cx = 319.5;
  camera.cy = 239.5;
  return camera;
}

// Whether the points fall on the camera's pixels; 99 % of those in front of it.
bool
fits(const RawCloud& raw, const Intrinsics& camera, int width, int height)
{
  std::size_t on = 0, all = 0;
  for (const Record& r : raw.records) {
    if (!measured(r))
      continue;
    ++all;
    const Eigen::Vector2d p = camera.project({r.x, r.y, r.z});
    const Eigen::Vector2d pixel(std::round(p.x()), std::round(p.y()));
    if ((p - pixel).cwiseAbs().maxCoeff() < 0.05 && pixel.minCoeff() >= 0 &&
        pixel.x() < width && pixel.y() < height)
      ++on;
  }
  return all > 0 && on * 100 >= all * 99;
}

void
placeByProjection(const std::string& file,
                  RawCloud& raw,
                  const LoadOptions& options,
                  pcl::PointCloud<pcl::PointXYZRGB>& cloud)
{
  const bool given = options.intrinsics.has_value();
  const Intrinsics camera = given ? *options.intrinsics : kinect();
  if (!camera.valid() || !(camera.cx < max_side) || !(camera.cy < max_side))
    throw LoadError(file, "", "the given intrinsics are not those of a camera");
  const int width =
      options.width > 0 ? options.width : static_cast<int>(2 * camera.cx + 1.5);
  const int height =
      options.height > 0 ? options.height : static_cast<int>(2 * camera.cy + 1.5);
  if (!given && !fits(raw, camera, width, height))
    throw LoadError(file,
                    "",
                    "is not organized (height 1), has no fields u and v, and does not "
                    "lie on a Kinect's pixels; give the camera's intrinsics");
  prepare(file, width, height, raw.records.size(), cloud);
  std::size_t outside = 0;
  for (const Record& r : raw.records) {
    if (!measured(r))
      continue;
    const Eigen::Vector2d p = camera.project({r.x, r.y, r.z});
    const double u = std::round(p.x()), v = std::round(p.y());
    if (u >= 0 && v >= 0 && u < width && v < height)
      place(cloud, static_cast<std::uint32_t>(u), static_cast<std::uint32_t>(v), r);
    else
      ++outside;
  }
  raw.warnings.push_back(std::string("the grid was rebuilt by projection with ") +
                         (given ? "the given intrinsics" : "the Kinect's intrinsics"));
  if (outside > 0)
    raw.warnings.push_back(std::to_string(outside) + " points lie outside the image");
}

void
setPose(const RawCloud& raw, LoadedFrame& frame)
{
  const double norm = raw.orientation.norm();
  if (!(norm > 1e-6) || !std::isfinite(norm) || !raw.origin.allFinite()) {
    frame.warnings.emplace_back("the sensor pose is no rotation and is ignored");
    return;
  }
  if (std::abs(norm - 1) > 1e-3)
    frame.warnings.emplace_back("the sensor pose's quaternion is not of length 1");
  frame.pose.linear() = raw.orientation.normalized().toRotationMatrix();
  frame.pose.translation() = raw.origin;
  frame.pose_known = !frame.pose.isApprox(Eigen::Isometry3d::Identity(), 1e-12);
  frame.cloud->sensor_origin_ << raw.origin.cast<float>(), 0;
  frame.cloud->sensor_orientation_ = raw.orientation.normalized().cast<float>();
}

} // namespace

void
makeFrame(const std::string& file,
          RawCloud&& raw,
          const LoadOptions& options,
          LoadedFrame& frame)
{
  auto& cloud = *frame.cloud;
  if (raw.height > 1) {
    if (raw.width > static_cast<std::uint64_t>(max_side) ||
        raw.height > static_cast<std::uint64_t>(max_side))
      throw LoadError(file, "", "no camera has so wide an image");
    cloud.resize(static_cast<std::uint32_t>(raw.width),
                 static_cast<std::uint32_t>(raw.height));
    for (std::size_t i = 0; i < raw.records.size(); ++i)
      fill(cloud[i], raw.records[i]);
  }
  else if (raw.has_pixels)
    placeByPixels(file, raw, options, cloud);
  else
    placeByProjection(file, raw, options, cloud);
  raw.records = {};

  std::size_t points = 0;
  cv::Mat3f image(static_cast<int>(cloud.height), static_cast<int>(cloud.width));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    image(static_cast<int>(i)) = {cloud[i].x, cloud[i].y, cloud[i].z};
    points += std::isfinite(cloud[i].z) ? 1 : 0;
  }
  cloud.is_dense = points == cloud.size();
  frame.intrinsics = estimateIntrinsics(image);
  frame.has_color = raw.has_color;
  frame.format = raw.format;
  frame.warnings = std::move(raw.warnings);
  setPose(raw, frame);
  if (points == 0)
    frame.warnings.emplace_back("no point in front of the camera was measured");
  else if (!frame.intrinsics.valid())
    frame.warnings.emplace_back("too few points to recover the camera from");
  else if (frame.intrinsics.rms > 1)
    frame.warnings.push_back("the points are not those of a pinhole camera: they lie " +
                             std::to_string(frame.intrinsics.rms) +
                             " px from their pixels");
}

} // namespace detail
} // namespace hoist
