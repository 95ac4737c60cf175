#pragma once

#include <hoist/data/cuboid.h>
#include <hoist/data/result.h>
#include <hoist/segmentation/face_borders.h>
#include <hoist/segmentation/planar_faces.h>

#include <Eigen/Core>

#include <array>
#include <optional>
#include <vector>

namespace hoist {

/** \brief How the end of a box along an axis is known. */
enum class EndSource : unsigned char {
  bound,     ///< something covers it; the box reaches at least that far
  seen,      ///< outline, crease or plane
  contact,   ///< something that does not carry the box touches it there; it may go on
             ///< behind that
  bracketed, ///< covered, but known to lie in an interval of 15 % of the side and a few
             ///< pixels at most: farther out the background is seen
  support,   ///< covered; taken from the surface it stands on or leans against
  catalogue, ///< as far from the other end as a known box is long
  unknown    ///< behind the only face that is seen, by a length that means nothing
};

/** \brief A box that may be there. Camera frame, metres.
 *
 * The box is axes * [lower, upper]: its points have axes^T x between lower and upper.
 */
struct CuboidHypothesis {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity(); ///< right handed
  Eigen::Vector3d lower = Eigen::Vector3d::Zero();
  Eigen::Vector3d upper = Eigen::Vector3d::Zero();
  /// How each end is known: lower 0, upper 0, lower 1, ...
  std::array<EndSource, 6> ends{};
  /// Faces that touch the box from in front at its ends, -1 where none.
  std::array<int, 6> contacts{-1, -1, -1, -1, -1, -1};
  /// Length of the interval in which an end lies that is bracketed or of a catalogue
  /// [m], 0 at other ends.
  std::array<double, 6> room{};
  /// Lengths of sides that do not come from the frame [m], 0 for those that do.
  std::array<double, 3> given{};
  std::array<int, 2> faces{-1, -1}; ///< the faces it was built from
  CuboidModel model = CuboidModel::faces;

  Eigen::Vector3d
  center() const
  {
    return axes * (lower + upper) / 2;
  }
  Eigen::Vector3d
  size() const
  {
    return upper - lower;
  }

  /// Where the box ends along its axis: lower 0, upper 0, lower 1, ...
  double
  end(int f) const
  {
    return f % 2 == 0 ? lower[f / 2] : upper[f / 2];
  }
  double&
  end(int f)
  {
    return f % 2 == 0 ? lower[f / 2] : upper[f / 2];
  }

  /// +1 at upper ends, -1 at lower ones: times the axis, the outward normal.
  static double
  side(int f)
  {
    return f % 2 == 0 ? -1.0 : 1.0;
  }
  Eigen::Vector3d
  outward(int f) const
  {
    return side(f) * axes.col(f / 2);
  }
};

struct CuboidHypothesisParameters {
  SensorModel sensor;
  double min_side = 0.015; ///< [m]
  double max_side = 5.0;   ///< [m]
  /// Faces whose angle differs from 90 degrees by more, beyond their own tilt
  /// uncertainty, are no pair [rad]. Kinects whose principal point is off show true
  /// right angles at 88 to 92 degrees.
  double angle_tolerance = 0.12;
  /// What everything stands on, if it is known: a x + b y + c z + d = 0 in the camera
  /// frame [m], (a, b, c) of any length but 0.
  std::optional<Eigen::Vector4d> support_plane;
};

/** \brief Boxes from pairs of perpendicular faces that meet convexly.
 *
 * The pair fixes the orientation and one end of two axes; the other four ends are where
 * the outlines of the two faces pile up along each axis (a vote in one dimension, the
 * Hough transform of a line of known direction). Where the faces disagree, each
 * combination becomes a hypothesis of its own.
 */
HOIST_SEGMENTATION_EXPORT void
cuboidsFromFacePairs(const std::vector<PlanarFace>& faces,
                     const FaceBorders& borders,
                     const Intrinsics& camera,
                     const CuboidHypothesisParameters& parameters,
                     std::vector<CuboidHypothesis>& hypotheses,
                     Diagnostics& diagnostics);

/** \brief Boxes of which one face alone is seen.
 *
 * For each face that ends along a rectangle. How far the box reaches behind it is not
 * known: that end is EndSource::unknown, put a pixel's footprint behind the face. Faces
 * of fewer than 400 pixels are left out.
 *
 * \param hypotheses camera frame [m]; appended to
 */
HOIST_SEGMENTATION_EXPORT void
cuboidsFromSingleFaces(const std::vector<PlanarFace>& faces,
                       const FaceBorders& borders,
                       const Intrinsics& camera,
                       const CuboidHypothesisParameters& parameters,
                       std::vector<CuboidHypothesis>& hypotheses);

/** \brief Settles what touches the boxes, and adds those that reach on to a surface.
 *
 * A contact that lies under the box, seen from its end, carries it: the end becomes
 * EndSource::seen. Then, for each end that is still covered or touched, a box is added
 * that reaches on to the nearest face that is parallel to the end and beyond it, or to
 * the support plane if one is given; nothing seen contradicts it, and its end is marked
 * EndSource::support. What reaches through the given plane ends there.
 *
 * \param hypotheses changed and appended to
 */
HOIST_SEGMENTATION_EXPORT void
extendToSupport(const std::vector<PlanarFace>& faces,
                const FaceBorders& borders,
                const CuboidHypothesisParameters& parameters,
                std::vector<CuboidHypothesis>& hypotheses);

/** \brief Looks behind what covers an end of a box.
 *
 * Where a face that reached on by more than 15 % of the side would hide background that
 * the sensor saw, the end lies in between: a box is added whose end is put into the
 * middle and marked EndSource::bracketed.
 *
 * \param hypotheses appended to
 */
HOIST_SEGMENTATION_EXPORT void bracketEnds(const cv::Mat1f& inverse_depth,
                                           const Intrinsics& camera,
                                           const CuboidHypothesisParameters& parameters,
                                           std::vector<CuboidHypothesis>& hypotheses);

} // namespace hoist
