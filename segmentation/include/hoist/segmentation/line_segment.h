#pragma once

#include <hoist/segmentation/export.h>

#include <Eigen/Core>

#include <pcl/types.h>

#include <array>
#include <vector>

namespace hoist {

/** \brief A straight edge in the image and in space (paper, Table 2).
 *
 * Frame: the camera's; pixels are (u, v) = (column, row), space in metres. Class
 * invariant: pixels[k] projects points[k] up to the lift's residual; length > 0.
 */
struct LineSegment {
  std::array<Eigen::Vector2f, 2> pixels; ///< end points in the image [px]
  std::array<Eigen::Vector3d, 2> points; ///< end points in space [m]
  pcl::Indices indices;                  ///< supporting pixels, indices into the cloud
  double sigma = 0; ///< rms distance of the support to the line [m]

  /// Table 2's spatial direction vector, point 2 - point 1, not normalised [m].
  Eigen::Vector3d
  delta() const
  {
    return points[1] - points[0];
  }

  /// Table 2's E [m].
  double
  length() const
  {
    return delta().norm();
  }

  /// Unit direction from point 1 to point 2.
  Eigen::Vector3d
  direction() const
  {
    return delta().normalized();
  }
};

/** \brief An end of a segment: the segment's number and 0 or 1. */
struct SegmentEnd {
  int segment = 0;
  int end = 0;
};

/** \brief A cluster of segment ends within distance D (paper 4.2.3). */
struct Vertex {
  Eigen::Vector3d point = Eigen::Vector3d::Zero(); ///< mean of the ends [m]
  std::vector<SegmentEnd> ends;                    ///< sorted by segment, then end

  /// How many different segments meet here (the paper's aggregation degree).
  HOIST_SEGMENTATION_EXPORT int aggregationDegree() const;
};

} // namespace hoist
