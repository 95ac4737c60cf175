#pragma once

#include "evaluate/evaluation.h"

#include <string>

namespace hoist {

/** \brief Draws precision_recall.png, errors.png, distance.png, scores.png and
 *  sigmas.png into \a folder; what there are no figures for is left out.
 *  \throws FileError, pcl::IOException */
void writePlots(const std::string& folder, const Evaluation& evaluation);

} // namespace hoist
