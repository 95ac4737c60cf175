#pragma once

#include "evaluate/evaluate_settings.h"

#include <hoist/data/annotation.h>
#include <hoist/data/prediction.h>

#include <string>
#include <vector>

namespace hoist {

/** \brief What is true of a frame beside what was found in it. */
struct EvaluatedScene {
  std::string name; ///< path of the annotation in its folder, without ".json"
  std::vector<AnnotatedObject> truths;
  std::vector<Prediction> predictions; ///< the highest score first
};

/** \brief Scenes in natural order of their names: learn2 before learn10. */
struct EvaluatedScenes {
  std::vector<EvaluatedScene> scenes;
  std::vector<std::string> notes; ///< what the user should know, a line each
};

/** \brief Finds and reads both sides.
 *
 * A folder is searched with all that is in it. A result belongs to the annotation of
 * the same path in its folder, or else of the same name; a file with several frames is
 * told apart by their field `scene`. A scene without results counts as one in which
 * nothing was found, but where RESULTS is one file of one frame, its scene alone
 * counts. \throws UsageError where nothing fits together, LoadError where a file is
 * broken */
EvaluatedScenes loadScenes(const EvaluateSettings& settings);

/** \brief Digits compare as numbers, all else by bytes. */
bool naturallyLess(const std::string& a, const std::string& b);

} // namespace hoist
