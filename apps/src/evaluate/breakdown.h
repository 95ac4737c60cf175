#pragma once

#include "evaluate/evaluation.h"

namespace hoist {

/** \brief Recall, F1 and errors by distance, visible fraction and visible faces, each
 *  where the truth says it of anything. Expects evaluation.matches and hits. */
std::vector<Breakdown> breakdownsOf(const std::vector<EvaluatedScene>& scenes,
                                    const Evaluation& evaluation);

/** \brief What errors of these hits look like. */
ErrorSummary errorSummary(const std::vector<const Hit*>& hits,
                          const std::vector<EvaluatedScene>& scenes);

} // namespace hoist
