#pragma once

#include <hoist/segmentation/cuboid_selection.h>

namespace hoist {
namespace detail {

/** \brief A candidate as it is reported: canonical axes, what was seen of it, and how
 *  well each dimension is known. */
Cuboid toCuboid(const CuboidCandidate& candidate);

} // namespace detail
} // namespace hoist
