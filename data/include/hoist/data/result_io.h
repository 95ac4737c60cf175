#pragma once

#include <hoist/data/export.h>
#include <hoist/data/load_error.h>
#include <hoist/data/result.h>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace hoist {

/** \brief A result as JSON text; the schema is in docs/results.md.
 *
 * Doubles come back bit for bit. Numbers that are not finite are null.
 * \param indent spaces per level; -1 for one line
 */
HOIST_DATA_EXPORT std::string toJson(const FrameResult& result, int indent = 1);

/** \brief The result in a JSON text as toJson() writes it. Indices of pixels, segments
 *  and vertices are not part of it.
 *  \param name of the file, for messages
 *  \throws LoadError */
HOIST_DATA_EXPORT FrameResult fromJson(const std::string& text,
                                       const std::string& name = "JSON");

/** \brief A text as one field of a CSV line (RFC 4180): in quotes where it must be. */
HOIST_DATA_EXPORT std::string csvField(const std::string& text);

/** \brief One line per cuboid, with a header line; RFC 4180, decimal points.
 *  \param header false to append to another table */
HOIST_DATA_EXPORT std::string toCsv(const FrameResult& result, bool header = true);

/** \brief The frame with a label per pixel: 0 for none, k for the k-th cuboid from 1.
 *
 * A pixel that supports several cuboids belongs to the one with the highest score.
 * \throws pcl::BadArgumentException if an index lies outside the cloud
 */
HOIST_DATA_EXPORT pcl::PointCloud<pcl::PointXYZRGBL>
labelledCloud(const pcl::PointCloud<pcl::PointXYZRGB>& cloud,
              const FrameResult& result);

/** \brief The twelve edges of every cuboid as an ASCII PLY with vertices and edges.
 *  \param world in the world frame, if the pose is known */
HOIST_DATA_EXPORT std::string toWireframePly(const FrameResult& result,
                                             bool world = false);

/** \brief A cuboid in the world frame: centre and axes moved, all else as it is. */
HOIST_DATA_EXPORT Cuboid transformed(const Cuboid& cuboid,
                                     const Eigen::Isometry3d& pose);

/** \brief Writes toJson() so that readers see the old file or the new one.
 *  \throws pcl::IOException */
HOIST_DATA_EXPORT void saveJson(const std::filesystem::path& file,
                                const FrameResult& result);

/** \brief Reads what saveJson() wrote.
 *  \throws LoadError */
HOIST_DATA_EXPORT FrameResult loadJson(const std::filesystem::path& file);

/** \brief Writes toCsv() of all results as one table, likewise.
 *  \throws pcl::IOException */
HOIST_DATA_EXPORT void saveCsv(const std::filesystem::path& file,
                               const std::vector<FrameResult>& results);

/** \brief Writes labelledCloud() as binary_compressed PCD, likewise.
 *  \throws pcl::IOException */
HOIST_DATA_EXPORT void saveLabelledCloud(const std::filesystem::path& file,
                                         const pcl::PointCloud<pcl::PointXYZRGB>& cloud,
                                         const FrameResult& result);

/** \brief Writes toWireframePly(), likewise.
 *  \throws pcl::IOException */
HOIST_DATA_EXPORT void saveWireframePly(const std::filesystem::path& file,
                                        const FrameResult& result,
                                        bool world = false);

} // namespace hoist
