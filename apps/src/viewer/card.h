#pragma once

#include "viewer/scene.h"

#include <string>
#include <vector>

namespace hoist {

/** \brief All that is known of a scene's i-th cuboid, line by line: number, class, size
 *  with sigma, centre, pose, colour, weight, score, model, observed faces. */
std::vector<std::string> cardText(const Scene& scene, std::size_t cuboid);

/** \brief What is known of the i-th of shownRejections(). */
std::vector<std::string> rejectionText(const Scene& scene, std::size_t rejection);

} // namespace hoist
