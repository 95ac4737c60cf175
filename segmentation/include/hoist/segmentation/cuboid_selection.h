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
  const char* rejected = nullptr; ///< why it is no cuboid, a literal; else nullptr
};

/** \brief Whether two boxes share more than a quarter of either one's volume. */
HOIST_SEGMENTATION_EXPORT bool excludeEachOther(const CuboidHypothesis& a,
                                                const CuboidHypothesis& b);

/** \brief Chooses the set of candidates that explains the most of the frame without
 *  explaining anything twice.
 *
 * Value of a set: the sum of CuboidEvidence::value() over its members, no two of which
 * may exclude each other. Greedy by value, then single exchanges until none helps.
 *
 * \param candidates those that are rejected already take no part; the others that are
 *        not chosen are rejected here
 * \param chosen out: indices into candidates, best score first
 */
HOIST_SEGMENTATION_EXPORT void selectCuboids(std::vector<CuboidCandidate>& candidates,
                                             std::vector<int>& chosen);

} // namespace hoist
