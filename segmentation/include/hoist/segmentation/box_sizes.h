#pragma once

#include <hoist/segmentation/cuboid_hypotheses.h>
#include <hoist/segmentation/export.h>

#include <Eigen/Core>

#include <array>
#include <limits>
#include <vector>

namespace hoist {

/** \brief What a side may measure [m]. */
struct SideRange {
  double min = 0;
  double max = std::numeric_limits<double>::infinity();
};

/** \brief What is known beforehand of the boxes' sizes. Lengths in metres. */
struct BoxSizes {
  double min_side = 0.015; ///< of every side, > 0
  double max_side = 5.0;   ///< of every side, >= min_side

  /// Of the longest, the middle and the shortest side; each max >= its min >= 0.
  std::array<SideRange, 3> ranges;

  /// A catalogue: if there are any, only boxes of these sizes count, and a side that is
  /// not seen is taken from here. Three lengths > 0 each, in any order.
  std::vector<Eigen::Vector3d> known;
  /// How far a side may be from the catalogue's, > 0.
  double tolerance = 0.01;

  HOIST_SEGMENTATION_EXPORT bool valid() const;
};

/** \brief Whether a box can be of a size that is asked for.
 *
 * A side of which an end is hidden may be longer than it is known to be; one that
 * cannot be seen at all may have any length. min_side counts for what is known of a
 * side.
 *
 * \param slack by how much every side may be wrong [m]
 * \return nullptr if it can, else the reason, a literal
 */
HOIST_SEGMENTATION_EXPORT const char*
sizeRejection(const CuboidHypothesis& hypothesis, const BoxSizes& sizes, double slack);

/** \brief Adds, for each box with a side that is not known to both ends, those of the
 *  catalogue that fit what is seen of it: EndSource::catalogue at the hidden end.
 *
 * A side of which neither end is seen stays as it is: the box could lie anywhere along
 * it. A side that is seen may differ by the tolerance, three pixels and three sigma.
 *
 * \param sizes valid()
 * \param camera valid intrinsics
 * \param hypotheses camera frame [m]; appended to
 */
HOIST_SEGMENTATION_EXPORT void
completeFromCatalogue(const BoxSizes& sizes,
                      const Intrinsics& camera,
                      const SensorModel& sensor,
                      std::vector<CuboidHypothesis>& hypotheses);

} // namespace hoist
