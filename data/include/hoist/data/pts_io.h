#pragma once

#include <hoist/data/export.h>
#include <hoist/data/pts_stream.h>

#include <pcl/PCLPointCloud2.h>
#include <pcl/conversions.h>
#include <pcl/io/file_io.h>
#include <pcl/memory.h>
#include <pcl/point_cloud.h>

#include <cmath>
#include <string>
#include <vector>

namespace hoist {

/** \brief Reads PTS text files of all dialects as PCL reads PCD files.
 *
 * Follows pcl::FileReader: a negative return value and a PCL_ERROR message on failure,
 * with the output cleared. Fields of the cloud: x y z, rgba, intensity, normal_x
 * normal_y normal_z, u v, in the order of the file's columns, as far as it has them.
 */
class HOIST_DATA_EXPORT PTSReader : public pcl::FileReader {
public:
  using Ptr = pcl::shared_ptr<PTSReader>;
  using ConstPtr = pcl::shared_ptr<const PTSReader>;

  void
  setOptions(const PTSOptions& options)
  {
    options_ = options;
  }

  const PTSOptions&
  getOptions() const
  {
    return options_;
  }

  /** \brief What the last successful read found. */
  const PTSReport&
  getReport() const
  {
    return report_;
  }

  using pcl::FileReader::read;

  /** \brief Fields and size only; width is an upper bound where records without depth
   *  will be dropped. */
  int readHeader(const std::string& file_name,
                 pcl::PCLPointCloud2& cloud,
                 Eigen::Vector4f& origin,
                 Eigen::Quaternionf& orientation,
                 int& file_version,
                 int& data_type,
                 unsigned int& data_idx,
                 const int offset = 0) override;

  int read(const std::string& file_name,
           pcl::PCLPointCloud2& cloud,
           Eigen::Vector4f& origin,
           Eigen::Quaternionf& orientation,
           int& file_version,
           const int offset = 0) override;

private:
  PTSOptions options_;
  PTSReport report_;
};

/** \brief Reads a whole PTS file.
 *  \throws LoadError */
HOIST_DATA_EXPORT PTSReport readPTS(const std::string& file,
                                    pcl::PCLPointCloud2& cloud,
                                    const PTSOptions& options = {},
                                    std::size_t byte_offset = 0);

/** \brief The same into a typed cloud, without a second copy of the whole cloud in
 *  memory. Fields that PointT has and the file has not keep their default.
 *  \throws LoadError */
template <typename PointT>
PTSReport
readPTS(const std::string& file,
        pcl::PointCloud<PointT>& cloud,
        const PTSOptions& options = {})
{
  cloud = pcl::PointCloud<PointT>();
  PTSStream stream(file, options);
  pcl::PCLPointCloud2 block;
  block.height = 1;
  block.fields = stream.fields();
  block.point_step = static_cast<std::uint32_t>(stream.pointStep());
  block.is_dense = true;
  pcl::MsgFieldMap map;
  pcl::createMapping<PointT>(block.fields, map);
  pcl::PointCloud<PointT> points;
  const auto convert = [&](std::size_t n) {
    block.width = static_cast<std::uint32_t>(n);
    block.row_step = block.width * block.point_step;
    pcl::fromPCLPointCloud2(block, points, map);
  };

  if (!stream.organized()) {
    cloud.points.reserve(stream.maxRecords());
    while (const std::size_t n = stream.next(block.data)) {
      convert(n);
      cloud.points.insert(cloud.points.end(), points.begin(), points.end());
    }
    cloud.width = static_cast<std::uint32_t>(cloud.points.size());
    cloud.height = 1;
    cloud.is_dense = true;
    return stream.report();
  }

  const int width = stream.width(), height = stream.height();
  cloud.points.reserve(static_cast<std::size_t>(width) * height);
  for (int v = 0; v < height; ++v) {
    stream.blankRow(v, block.data);
    convert(static_cast<std::size_t>(width));
    cloud.points.insert(cloud.points.end(), points.begin(), points.end());
  }
  std::vector<bool> taken(cloud.points.size());
  std::size_t measured = 0;
  while (const std::size_t n = stream.next(block.data)) {
    convert(n);
    for (std::size_t i = 0; i < n; ++i) {
      int u = 0, v = 0;
      float z = 0;
      stream.pixelOf(&block.data[i * block.point_step], u, v, z);
      const std::size_t cell = static_cast<std::size_t>(v) * width + u;
      PointT& old = cloud.points[cell];
      const bool had_depth = std::isfinite(old.z);
      stream.report().repeated_pixels += taken[cell] ? 1 : 0;
      // of several records on one pixel the nearest stays; one with depth beats one
      // without
      if (!taken[cell] || (std::isfinite(z) && !(had_depth && old.z <= z))) {
        old = points[i];
        measured += std::isfinite(z) && !had_depth ? 1 : 0;
      }
      taken[cell] = true;
    }
  }
  cloud.width = static_cast<std::uint32_t>(width);
  cloud.height = static_cast<std::uint32_t>(height);
  cloud.is_dense = measured == cloud.points.size();
  return stream.report();
}

/** \brief Loads a PTS file as pcl::io::loadPCDFile loads a PCD file.
 *  \return 0, or -1 with a PCL_ERROR message and the cloud cleared */
HOIST_DATA_EXPORT int loadPTSFile(const std::string& file, pcl::PCLPointCloud2& cloud);

template <typename PointT>
int
loadPTSFile(const std::string& file, pcl::PointCloud<PointT>& cloud)
{
  try {
    readPTS(file, cloud);
    return 0;
  }
  catch (const LoadError& error) {
    PCL_ERROR("[hoist::loadPTSFile] %s\n", error.what());
    cloud = pcl::PointCloud<PointT>();
    return -1;
  }
}

/** \brief Which columns a PTS file gets. */
enum class PTSDialect {
  automatic, ///< Bumblebee if the cloud is organized or has u and v; else by its fields
  bumblebee, ///< x y z R G B row col, no header
  xyz,
  xyzi,
  xyzrgb,
  xyzirgb
};

/** \brief Writes PTS text files.
 *
 * Numbers are written locale-independently. The file appears under its name only when
 * it is complete.
 */
class HOIST_DATA_EXPORT PTSWriter : public pcl::FileWriter {
public:
  using Ptr = pcl::shared_ptr<PTSWriter>;
  using ConstPtr = pcl::shared_ptr<const PTSWriter>;

  void
  setDialect(PTSDialect dialect)
  {
    dialect_ = dialect;
  }

  PTSDialect
  getDialect() const
  {
    return dialect_;
  }

  /** \brief Digits after the point, 0..20; -1 (default): as many as bring the same
   *  float back. The camera's own software writes 6. */
  void
  setDecimals(int decimals)
  {
    decimals_ = decimals;
  }

  int
  getDecimals() const
  {
    return decimals_;
  }

  /** \brief Bumblebee: whether pixels without depth are written, as 0 0 0 R G B row
   *  col (default), so that their colour and the size of the grid survive; else they
   *  are left out. Other dialects always leave them out. */
  void
  setWriteInvalid(bool write_invalid)
  {
    write_invalid_ = write_invalid;
  }

  bool
  getWriteInvalid() const
  {
    return write_invalid_;
  }

  using pcl::FileWriter::write;

  /** \brief Follows pcl::FileWriter; \a binary must be false.
   *  \return 0, or -1 with a PCL_ERROR message and no file written */
  int write(const std::string& file_name,
            const pcl::PCLPointCloud2& cloud,
            const Eigen::Vector4f& origin = Eigen::Vector4f::Zero(),
            const Eigen::Quaternionf& orientation = Eigen::Quaternionf::Identity(),
            const bool binary = false) override;

private:
  PTSDialect dialect_ = PTSDialect::automatic;
  int decimals_ = -1;
  bool write_invalid_ = true;
};

/** \brief Saves a cloud with PTSWriter's defaults.
 *  \return 0, or -1 with a PCL_ERROR message */
HOIST_DATA_EXPORT int savePTSFile(const std::string& file,
                                  const pcl::PCLPointCloud2& cloud);

template <typename PointT>
int
savePTSFile(const std::string& file, const pcl::PointCloud<PointT>& cloud)
{
  pcl::PCLPointCloud2 blob;
  pcl::toPCLPointCloud2(cloud, blob);
  return savePTSFile(file, blob);
}

} // namespace hoist
