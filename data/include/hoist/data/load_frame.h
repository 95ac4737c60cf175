#pragma once

#include <hoist/data/export.h>
#include <hoist/data/intrinsics.h>
#include <hoist/data/load_error.h>
#include <hoist/data/pts_stream.h>

#include <Eigen/Geometry>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace hoist {

/** \brief A frame as the rest of hoist takes it. */
struct LoadedFrame {
  /// Organized; x, y, z NaN where nothing was measured, is_dense says so truly. The
  /// sensor pose of the file is in sensor_origin_ and sensor_orientation_.
  pcl::PointCloud<pcl::PointXYZRGB>::Ptr cloud;
  Intrinsics
      intrinsics; ///< recovered from the points; not valid() with too few of them
  bool has_color = false; ///< rgb or, as grey, intensity
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); ///< sensor to world
  bool pose_known = false; ///< the file holds a pose other than the identity
  std::string format; ///< e.g. "PCD binary_compressed", "PTS Bumblebee", "PLY ascii"
  std::vector<std::string> warnings; ///< in words, for people
};

/** \brief How to read what the file does not say itself. */
struct LoadOptions {
  PTSOptions pts; ///< for PTS files
  /// The camera of clouds that have lost their grid.
  std::optional<Intrinsics> intrinsics;
  /// Size of the grid to rebuild [px]; 0: 2 cx + 1 by 2 cy + 1.
  int width = 0;
  int height = 0;
  std::size_t max_points = std::size_t(1) << 26; ///< more are refused
};

/** \brief The one door for frames: PCD (ascii, binary, binary_compressed), PTS, PLY.
 *
 * The format follows from the name's ending, in any case: .pcd, .ply, .pts; .xyz, .asc
 * and .txt are read as PTS. Coordinates of any number type are converted to float;
 * points that are not finite or not in front of the camera (z <= 0) become NaN.
 *
 * A cloud that has lost its grid (height 1) gets it back from fields u and v; else by
 * projection with \a options.intrinsics; else with the Kinect's 525 px, 319.5, 239.5 if
 * 99 % of the points fall on its 640 x 480 pixels within 0.05 px. The nearest of
 * several points on one pixel stays.
 *
 * Files are checked before memory is asked for: no input makes it crash, hang or use
 * memory that the file's own size does not justify.
 * \throws LoadError naming file, position and cause
 */
HOIST_DATA_EXPORT LoadedFrame loadFrame(const std::string& file,
                                        const LoadOptions& options = {});

} // namespace hoist
