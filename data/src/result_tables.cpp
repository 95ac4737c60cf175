// CSV, labelled clouds and wireframes.
#include <hoist/data/atomic_file.h>
#include <hoist/data/result_io.h>

#include <pcl/exceptions.h>
#include <pcl/io/pcd_io.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <system_error>

namespace hoist {
namespace {

// The shortest text that gives the same double; empty for what is not finite.
std::string
number(double value)
{
  if (!std::isfinite(value))
    return "";
  char buffer[64];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

} // namespace

std::string
csvField(const std::string& text)
{
  if (text.find_first_of(",\"\r\n") == std::string::npos)
    return text;
  std::string out = "\"";
  for (const char c : text) {
    out += c;
    if (c == '"')
      out += c;
  }
  return out + '"';
}

std::string
toCsv(const FrameResult& result, bool header)
{
  std::string out;
  if (header)
    out = "scene,number,score,model,center_x,center_y,center_z,length,width,height,"
          "qw,qx,qy,qz,length_sigma,width_sigma,height_sigma,color,red,green,blue,"
          "material,weight,world_x,world_y,world_z\r\n";
  std::size_t i = 0;
  for (const RecognizedCuboid& item : result.cuboids) {
    const Cuboid& c = item.cuboid;
    const Eigen::Quaterniond q(c.axes);
    out += csvField(result.scene) + ',' + std::to_string(++i) + ',' + number(c.score) +
           ',' + toString(c.model);
    for (const double value : {c.center.x(),
                               c.center.y(),
                               c.center.z(),
                               c.size[0],
                               c.size[1],
                               c.size[2],
                               q.w(),
                               q.x(),
                               q.y(),
                               q.z(),
                               c.size_sigma[0],
                               c.size_sigma[1],
                               c.size_sigma[2]})
      out += ',' + number(value);
    out += ',' + csvField(item.features.color_name);
    for (const unsigned char value : item.features.rgb)
      out += ',' + std::to_string(value);
    out += ',' + csvField(item.features.material) + ',' + number(item.features.weight);
    const Eigen::Vector3d world = result.pose * c.center;
    for (int k = 0; k < 3; ++k)
      out += ',' + (result.pose_known ? number(world[k]) : "");
    out += "\r\n";
  }
  return out;
}

pcl::PointCloud<pcl::PointXYZRGBL>
labelledCloud(const pcl::PointCloud<pcl::PointXYZRGB>& cloud, const FrameResult& result)
{
  pcl::PointCloud<pcl::PointXYZRGBL> out;
  out.header = cloud.header;
  out.sensor_origin_ = cloud.sensor_origin_;
  out.sensor_orientation_ = cloud.sensor_orientation_;
  out.resize(cloud.size());
  out.width = cloud.width;
  out.height = cloud.height;
  out.is_dense = cloud.is_dense;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    out[i].getVector4fMap() = cloud[i].getVector4fMap();
    out[i].rgba = cloud[i].rgba;
    out[i].label = 0;
  }
  std::vector<double> best(cloud.size(), -1);
  for (std::size_t k = 0; k < result.cuboids.size(); ++k) {
    const Cuboid& cuboid = result.cuboids[k].cuboid;
    for (const auto index : cuboid.indices) {
      if (index < 0 || static_cast<std::size_t>(index) >= cloud.size())
        PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                            "cuboid " << k + 1 << " is supported by pixel " << index
                                      << " of a cloud with " << cloud.size());
      if (cuboid.score > best[index]) {
        best[index] = cuboid.score;
        out[index].label = static_cast<std::uint32_t>(k + 1);
      }
    }
  }
  return out;
}

std::string
toWireframePly(const FrameResult& result, bool world)
{
  const std::size_t n = result.cuboids.size();
  std::string out = "ply\nformat ascii 1.0\ncomment cuboids of hoist, metres\n"
                    "element vertex " +
                    std::to_string(8 * n) +
                    "\nproperty double x\nproperty double y\nproperty double z\n"
                    "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                    "element edge " +
                    std::to_string(12 * n) +
                    "\nproperty int vertex1\nproperty int vertex2\nend_header\n";
  for (const RecognizedCuboid& item : result.cuboids) {
    const auto corners = world && result.pose_known
                             ? transformed(item.cuboid, result.pose).corners()
                             : item.cuboid.corners();
    for (int k = 0; k < 8; ++k) {
      for (int i = 0; i < 3; ++i)
        out += number(corners(i, k)) + ' ';
      const auto& rgb = item.features.rgb;
      out += std::to_string(rgb[0]) + ' ' + std::to_string(rgb[1]) + ' ' +
             std::to_string(rgb[2]) + '\n';
    }
  }
  for (std::size_t k = 0; k < n; ++k)
    for (const auto& edge : Cuboid::edges())
      out += std::to_string(8 * k + edge[0]) + ' ' + std::to_string(8 * k + edge[1]) +
             '\n';
  return out;
}

void
saveCsv(const std::filesystem::path& file, const std::vector<FrameResult>& results)
{
  std::string table = toCsv(FrameResult());
  for (const FrameResult& result : results)
    table += toCsv(result, false);
  writeFileAtomically(file, table);
}

void
saveLabelledCloud(const std::filesystem::path& file,
                  const pcl::PointCloud<pcl::PointXYZRGB>& cloud,
                  const FrameResult& result)
{
  AtomicFile out(file);
  // PCL insists on writing a file of its own: beside the temporary one, then copied
  std::filesystem::path beside = out.temporary();
  beside += ".pcd";
  const auto remove = [&] {
    std::error_code ignored;
    std::filesystem::remove(beside, ignored);
  };
  try {
    if (pcl::PCDWriter().writeBinaryCompressed(beside.string(),
                                               labelledCloud(cloud, result)) < 0)
      throw pcl::IOException(file.string() + ": cannot be written");
    std::ifstream in(beside, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    out.write(bytes);
  }
  catch (...) {
    remove();
    throw;
  }
  remove();
  out.commit();
}

void
saveWireframePly(const std::filesystem::path& file,
                 const FrameResult& result,
                 bool world)
{
  writeFileAtomically(file, toWireframePly(result, world));
}

} // namespace hoist
