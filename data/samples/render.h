#pragma once

#include "scene.h"

#include <opencv2/core.hpp>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <array>
#include <string>
#include <vector>

namespace hoist {
namespace samples {

/** \brief What the frame shows of one box. Counted before noise. */
struct BoxTruth {
  Box box;
  std::size_t visible_pixels = 0;
  std::size_t alone_pixels = 0;             ///< had nothing else been in the scene
  std::array<std::size_t, 6> face_pixels{}; ///< +axis 0, -axis 0, +axis 1, ...
  bool touches_border = false;              ///< the image cuts it

  /** \brief visible_pixels / alone_pixels; 0 outside the image. */
  double
  visibleFraction() const
  {
    return alone_pixels == 0 ? 0.0
                             : static_cast<double>(visible_pixels) /
                                   static_cast<double>(alone_pixels);
  }

  /** \brief Neither hit nor miss in an evaluation: less than 40 % of it is seen, the
   *  rule of the mOSD truth. */
  bool
  difficult() const
  {
    return visibleFraction() < 0.4;
  }

  /** \brief Faces with at least \a min_pixels pixels. */
  int facesVisible(std::size_t min_pixels = 10) const;

  /** \brief Which faces those are. */
  std::array<bool, 6> visibleFaces(std::size_t min_pixels = 10) const;
};

/** \brief The truth of a frame. */
struct FrameTruth {
  std::vector<BoxTruth> boxes;
  cv::Mat1i object;      ///< number of the thing seen, see Hit::object; -1 for nothing
  cv::Mat1b face;        ///< its face, see Hit::face; 255 for nothing
  cv::Mat1f exact_depth; ///< z before noise [m]; NaN for nothing
};

/** \brief A rendered frame. */
struct Frame {
  pcl::PointCloud<pcl::PointXYZRGB> cloud; ///< organized; NaN where not measured
  FrameTruth truth;
};

/** \brief Renders the scene by casting a ray through the centre of every pixel.
 *
 * Without noise every point lies on its pixel's ray at the exact depth, rounded once to
 * float. With noise: depth is taken at a laterally displaced pixel, disturbed by a
 * spatially correlated normal error of the sensor's sigma, and rounded to a step of the
 * disparity; pixels that the second eye does not see, and a share of those on
 * silhouettes, have no depth. Colour stays where depth is missing. The result depends
 * on the scene alone, not on the machine's random numbers or threads.
 */
Frame render(const Scene& scene);

/** \brief The truth as JSON, in the layout of the mOSD truth files: scene, intrinsics,
 *  support_plane (a b c d, normal towards the camera), cuboids, other_objects. */
std::string truthJson(const Scene& scene, const FrameTruth& truth);

} // namespace samples
} // namespace hoist
