#pragma once

#include "evaluate/evaluation.h"

#include <string>

namespace hoist {

/** \brief All figures as JSON text; lengths [m], angles [rad], what is not known null.
 *  The layout is in docs/evaluate.md. */
std::string evaluationJson(const std::vector<EvaluatedScene>& scenes,
                           const Evaluation& evaluation,
                           const EvaluateSettings& settings);

} // namespace hoist
