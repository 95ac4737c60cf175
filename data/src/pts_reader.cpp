#include <hoist/data/pts_io.h>

#include <cstring>
#include <limits>

namespace hoist {
namespace {

void
describe(const PTSStream& stream, pcl::PCLPointCloud2& cloud)
{
  cloud.fields = stream.fields();
  cloud.point_step = static_cast<std::uint32_t>(stream.pointStep());
  cloud.is_bigendian = false;
}

void
finish(pcl::PCLPointCloud2& cloud, std::size_t width, std::size_t height)
{
  cloud.width = static_cast<std::uint32_t>(width);
  cloud.height = static_cast<std::uint32_t>(height);
  cloud.row_step = cloud.width * cloud.point_step;
}

void
readRecords(PTSStream& stream, pcl::PCLPointCloud2& cloud)
{
  std::vector<std::uint8_t> block;
  // Reserved, not resized: memory that no record needs is never touched.
  cloud.data.reserve(stream.maxRecords() * stream.pointStep());
  while (stream.next(block) > 0)
    cloud.data.insert(cloud.data.end(), block.begin(), block.end());
  cloud.is_dense = true;
  finish(cloud, cloud.data.size() / cloud.point_step, 1);
}

void
readGrid(PTSStream& stream, pcl::PCLPointCloud2& cloud)
{
  const std::size_t step = stream.pointStep();
  const std::size_t width = static_cast<std::size_t>(stream.width());
  const std::size_t height = static_cast<std::size_t>(stream.height());
  std::vector<std::uint8_t> block;
  cloud.data.reserve(width * height * step);
  for (std::size_t v = 0; v < height; ++v) {
    stream.blankRow(static_cast<int>(v), block);
    cloud.data.insert(cloud.data.end(), block.begin(), block.end());
  }
  std::vector<bool> taken(width * height);
  std::size_t measured = 0;
  while (const std::size_t n = stream.next(block))
    for (std::size_t i = 0; i < n; ++i) {
      int u = 0, v = 0;
      float z = 0;
      stream.pixelOf(&block[i * step], u, v, z);
      const std::size_t cell = static_cast<std::size_t>(v) * width + u;
      std::uint8_t* const old = &cloud.data[cell * step];
      float old_z = 0;
      stream.pixelOf(old, u, v, old_z);
      stream.report().repeated_pixels += taken[cell] ? 1 : 0;
      // the nearest stays; a record with depth beats one without
      if (!taken[cell] || (std::isfinite(z) && !(std::isfinite(old_z) && old_z <= z))) {
        std::memcpy(old, &block[i * step], step);
        measured += std::isfinite(z) && !std::isfinite(old_z) ? 1 : 0;
      }
      taken[cell] = true;
    }
  cloud.is_dense = measured == width * height;
  finish(cloud, width, height);
}

} // namespace

PTSReport
readPTS(const std::string& file,
        pcl::PCLPointCloud2& cloud,
        const PTSOptions& options,
        std::size_t byte_offset)
{
  cloud = pcl::PCLPointCloud2();
  try {
    PTSStream stream(file, options, byte_offset);
    if (stream.maxRecords() > std::numeric_limits<std::uint32_t>::max())
      throw LoadError(file, "", "more points than a point cloud can hold");
    describe(stream, cloud);
    if (stream.organized())
      readGrid(stream, cloud);
    else
      readRecords(stream, cloud);
    return stream.report();
  }
  catch (const LoadError&) {
    cloud = pcl::PCLPointCloud2();
    throw;
  }
  catch (const std::bad_alloc&) {
    cloud = pcl::PCLPointCloud2();
    throw LoadError(file, "", "not enough memory for its points");
  }
}

int
PTSReader::readHeader(const std::string& file_name,
                      pcl::PCLPointCloud2& cloud,
                      Eigen::Vector4f& origin,
                      Eigen::Quaternionf& orientation,
                      int& file_version,
                      int& data_type,
                      unsigned int& data_idx,
                      const int offset)
{
  cloud = pcl::PCLPointCloud2();
  report_ = PTSReport();
  origin = Eigen::Vector4f::Zero();
  orientation = Eigen::Quaternionf::Identity();
  file_version = 0;
  data_type = 0; // text
  data_idx = 0;
  try {
    PTSStream stream(file_name, options_, static_cast<std::size_t>(offset));
    describe(stream, cloud);
    if (stream.organized())
      finish(cloud, stream.width(), stream.height());
    else
      finish(cloud, stream.maxRecords(), 1);
    report_ = stream.report();
    return 0;
  }
  catch (const LoadError& error) {
    PCL_ERROR("[hoist::PTSReader::readHeader] %s\n", error.what());
    return -1;
  }
}

int
PTSReader::read(const std::string& file_name,
                pcl::PCLPointCloud2& cloud,
                Eigen::Vector4f& origin,
                Eigen::Quaternionf& orientation,
                int& file_version,
                const int offset)
{
  report_ = PTSReport();
  origin = Eigen::Vector4f::Zero();
  orientation = Eigen::Quaternionf::Identity();
  file_version = 0;
  try {
    report_ = readPTS(file_name, cloud, options_, static_cast<std::size_t>(offset));
  }
  catch (const LoadError& error) {
    PCL_ERROR("[hoist::PTSReader::read] %s\n", error.what());
    return -1;
  }
  for (const std::string& warning : report_.warnings)
    PCL_WARN("[hoist::PTSReader::read] %s: %s\n", file_name.c_str(), warning.c_str());
  return 0;
}

int
loadPTSFile(const std::string& file, pcl::PCLPointCloud2& cloud)
{
  PTSReader reader;
  Eigen::Vector4f origin;
  Eigen::Quaternionf orientation;
  int version = 0;
  return reader.read(file, cloud, origin, orientation, version);
}

} // namespace hoist
