#pragma once

#include "evaluate/evaluation.h"

#include <string>

namespace hoist {

/** \brief The tables that a person reads: found and missed, errors, attributes,
 * classes, calibration. */
std::string evaluationText(const std::vector<EvaluatedScene>& scenes,
                           const Evaluation& evaluation,
                           const EvaluateSettings& settings);

/** \brief Per scene what was missed and what is wrong, at the first IoU; scenes without
 *  either are left out. */
std::string missesText(const std::vector<EvaluatedScene>& scenes,
                       const Evaluation& evaluation);

} // namespace hoist
