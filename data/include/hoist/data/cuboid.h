#pragma once

#include <hoist/data/export.h>

#include <Eigen/Core>
#include <Eigen/StdVector>

#include <pcl/types.h>

#include <array>
#include <limits>
#include <vector>

namespace hoist {

/** \brief What a cuboid was built from. */
enum class CuboidModel {
  vertex_one, ///< three perpendicular segments at one vertex (paper 4.2.4.1)
  vertex_two, ///< three perpendicular segments at the two ends of one (4.2.4.2)
  faces,      ///< perpendicular faces
  parallel,   ///< parallel segments without a visible vertex
  face        ///< one face only; one dimension is not observed
};

/** \brief Where a dimension comes from. */
enum class DimensionSource {
  measured,  ///< both ends were seen
  partial,   ///< one end is hidden: the size is a lower bound
  support,   ///< one end is the plane it stands on
  bracketed, ///< one end is hidden, but known to an interval that its sigma covers
  catalogue, ///< a known box
  unknown    ///< not observable in this view; the size is not a measurement
};

/** \brief Names as they appear in files: "I", "II", "faces", "parallel", "face". */
HOIST_DATA_EXPORT const char* toString(CuboidModel model);

/** \brief "measured", "partial", "support", "bracketed", "catalogue", "unknown". */
HOIST_DATA_EXPORT const char* toString(DimensionSource source);

/** \brief A box with pose, size and the evidence for it.
 *
 * Frame: the camera's, metres. Class invariants of a reported cuboid: axes is
 * orthonormal with determinant +1; size(0) >= size(1) >= size(2) > 0 (length, width,
 * height by convention); size(i) lies along column i of axes. Axes are canonical, see
 * canonicalize().
 */
struct Cuboid {
  Eigen::Vector3d center = Eigen::Vector3d::Zero(); ///< [m]
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Eigen::Vector3d size = Eigen::Vector3d::Zero(); ///< full side lengths [m]

  /// Standard deviations [m], [m], [rad]; NaN where none follows.
  Eigen::Vector3d center_sigma =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  Eigen::Vector3d size_sigma =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  double rotation_sigma = std::numeric_limits<double>::quiet_NaN();

  /// Faces seen: +axis 0, -axis 0, +axis 1, -axis 1, +axis 2, -axis 2.
  std::array<bool, 6> observed_faces{};
  std::array<DimensionSource, 3> dimension_source{};

  double score = 0; ///< in [0, 1]; the share of the frame's evidence that supports it
  CuboidModel model = CuboidModel::vertex_one;

  std::vector<int> segments; ///< supporting segments, indices into the result's list
  std::vector<int> vertices; ///< supporting vertices, indices into the result's list
  pcl::Indices indices;      ///< pixels that support it, indices into the cloud

  double
  volume() const
  {
    return size.prod();
  }

  /** \brief The eight corners as columns [m]; bit i of the column's number is set where
   *  the corner lies on the positive side of axis i. */
  HOIST_DATA_EXPORT Eigen::Matrix<double, 3, 8> corners() const;

  /** \brief Corner numbers of the twelve edges; edges 4i .. 4i+3 run along axis i. */
  HOIST_DATA_EXPORT static const std::array<std::array<int, 2>, 12>& edges();
};

/** \brief Renames the axes so that the same box always gets the same ones.
 *
 * Sorts the sizes descending and carries axes, sigmas, faces and sources along. Signs:
 * the last axis (height) and the first (length) are turned to point into the half space
 * of \a up, or of the camera's -z where they are level with it (within 0.1 of the
 * sine), or of +x where that is level too; the middle axis follows from the right hand
 * rule. Sizes that differ by less than their joint sigma are not ordered by size, so
 * that noise does not swap them: the one further from \a up comes first, where that is
 * tied the one less along the line of sight, then the one that runs from near left to
 * far right. Then size(i) may exceed size(i - 1) by that sigma.
 *
 * \param up a unit vector in the camera frame; the camera's -y unless gravity is known
 */
HOIST_DATA_EXPORT void
canonicalize(Cuboid& cuboid, const Eigen::Vector3d& up = Eigen::Vector3d(0, -1, 0));

} // namespace hoist
