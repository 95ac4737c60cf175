#include "commands.h"
#include "failures.h"

#include <hoist/data/atomic_file.h>
#include <hoist/data/load_frame.h>
#include <hoist/data/point_types.h>
#include <hoist/data/pts_io.h>

#include <pcl/conversions.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>
#include <string>

namespace hoist {
namespace {

namespace fs = std::filesystem;

struct ConvertSettings {
  std::string input;
  std::string output;
  bool ascii = false;
};

std::string
extensionOf(const std::string& file)
{
  std::string extension = fs::path(file).extension().string();
  std::transform(extension.begin(),
                 extension.end(),
                 extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

// Every point with its pixel, which is what keeps the grid in formats that have none.
pcl::PCLPointCloud2
withPixels(const LoadedFrame& frame)
{
  const auto& cloud = *frame.cloud;
  pcl::PointCloud<PointXYZRGBUV> points(cloud.width, cloud.height);
  points.is_dense = cloud.is_dense;
  for (std::uint32_t v = 0; v < cloud.height; ++v)
    for (std::uint32_t u = 0; u < cloud.width; ++u) {
      PointXYZRGBUV& p = points(u, v);
      p.getVector4fMap() = cloud(u, v).getVector4fMap();
      p.rgba = cloud(u, v).rgba;
      p.u = u;
      p.v = v;
    }
  pcl::PCLPointCloud2 blob;
  pcl::toPCLPointCloud2(points, blob);
  return blob;
}

pcl::PCLPointCloud2
plain(const LoadedFrame& frame)
{
  pcl::PCLPointCloud2 blob;
  if (frame.has_color)
    pcl::toPCLPointCloud2(*frame.cloud, blob);
  else {
    pcl::PointCloud<pcl::PointXYZ> points;
    pcl::copyPointCloud(*frame.cloud, points);
    pcl::toPCLPointCloud2(points, blob);
  }
  return blob;
}

int
writeAs(const std::string& extension,
        const std::string& file,
        const LoadedFrame& frame,
        bool ascii)
{
  const Eigen::Vector4f& origin = frame.cloud->sensor_origin_;
  const Eigen::Quaternionf& orientation = frame.cloud->sensor_orientation_;
  if (extension == ".pts")
    return PTSWriter().write(file, plain(frame), origin, orientation);
  if (extension == ".ply")
    return pcl::PLYWriter().write(
        file, withPixels(frame), origin, orientation, !ascii, /*use_camera=*/true);
  pcl::PCDWriter writer;
  return ascii ? writer.writeASCII(file, plain(frame), origin, orientation, 9)
               : writer.writeBinaryCompressed(file, plain(frame), origin, orientation);
}

int
convertFile(const ConvertSettings& settings)
{
  const std::string extension = extensionOf(settings.output);
  if (extension != ".pcd" && extension != ".pts" && extension != ".ply")
    throw UsageError("'" + settings.output + "' ends in none of .pcd, .pts, .ply");
  if (fs::exists(settings.output) && fs::equivalent(settings.input, settings.output))
    throw UsageError("input and output are the same file");
  const LoadedFrame frame = loadFrame(settings.input);
  // PCL's writers say no more than that they failed, so the folder is tried first
  AtomicFile file(settings.output);
  if (writeAs(extension, file.temporary().string(), frame, settings.ascii) < 0)
    throw FileError(settings.output + ": cannot be written");
  file.commit();
  return exit_ok;
}

} // namespace

Action
addConvertCommand(CLI::App& program)
{
  CLI::App* command = program.add_subcommand(
      "convert",
      "Rewrite a frame as PCD, PTS (Bumblebee) or PLY, by the ending of OUT");
  auto settings = std::make_shared<ConvertSettings>();
  command->add_option("IN", settings->input, "PCD, PTS or PLY file of a frame")
      ->required()
      ->check(CLI::ExistingFile)
      ->type_name("");
  command->add_option("OUT", settings->output, "The new file; replaced if it exists")
      ->required()
      ->type_name("");
  command->add_flag(
      "--ascii", settings->ascii, "PCD and PLY as text (default: binary)");
  command->footer(
      "\nPoints, colours and the sensor's pose are kept, other fields are "
      "not. PTS has no pose.\nPLY gets the pixel of every point as u, v.\n");
  return [settings] { return convertFile(*settings); };
}

} // namespace hoist
