#pragma once

#include <hoist/segmentation/cuboid_refinement.h>
#include <hoist/segmentation/cuboid_verification.h>

#include <vector>

namespace hoist {

/** \brief A hypothesis with its evidence. */
struct CuboidCandidate {
  CuboidHypothesis hypothesis;
  CuboidEvidence evidence;
  CuboidCovariance covariance;
  bool refined = false;
};

/** \brief Whether two boxes share more than a quarter of either one's volume. */
HOIST_SEGMENTATION_EXPORT bool excludeEachOther(const CuboidHypothesis& a,
                                                const CuboidHypothesis& b);

/** \brief Chooses the set of candidates that explains the most of the frame without
 *  explaining anything twice.
 *
 * Value of a set: the supported pixels of its members, each weighted by its member's
 * score; see excludeEachOther(). Greedy by value, then single exchanges until none
 * helps.
 *
 * \param chosen out: indices into candidates, best score first
 */
HOIST_SEGMENTATION_EXPORT void
selectCuboids(const std::vector<CuboidCandidate>& candidates,
              double min_score,
              std::vector<int>& chosen);

} // namespace hoist
