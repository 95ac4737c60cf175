#pragma once

#include <hoist/segmentation/cuboid_refinement.h>

#include <vector>

namespace hoist {
namespace detail {

/** \brief A pixel's side on the outline of a box, and the end that it lies at. */
struct OutlinePoint {
  const BorderElement* element;
  Eigen::Vector3d point; ///< [m]
  int face;              ///< of the box, whose outline it belongs to
  int end;               ///< of the box, lower 0, upper 0, lower 1, ...
  double sigma;          ///< along the end's axis [m]
  double start_sigma;    ///< the same while the ends are still rough [m]
  bool on_plane;         ///< moved onto the plane that carries the box
};

/** \brief Appends those border elements of a face of the frame that lie at hidden ends
 *  of the box.
 *  \param label number of the face in \a faces
 *  \param face the visible face of the box that it is
 *  \param noise sigma of the depth at the box [m] */
void addOutline(const CuboidHypothesis& box,
                const CuboidEvidence& evidence,
                int label,
                int face,
                const std::vector<PlanarFace>& faces,
                const FaceBorders& borders,
                const Intrinsics& camera,
                double noise,
                std::vector<OutlinePoint>& outline);

/** \brief Puts ends between the pixels where those of the outline do not contradict
 *  each other: an end lies between the last one on the face and the first one beyond
 *  it, finer than a pixel on a slanted edge. Any end in between gives the same pixels,
 *  so the middle is taken.
 *  \param pixel footprint at the box [m] */
void settleBetweenPixels(const std::vector<OutlinePoint>& outline,
                         const Intrinsics& camera,
                         double pixel,
                         CuboidHypothesis& box);

} // namespace detail
} // namespace hoist
