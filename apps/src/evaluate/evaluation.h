#pragma once

#include "evaluate/attributes.h"
#include "evaluate/calibration.h"
#include "evaluate/detection.h"
#include "evaluate/matching.h"
#include "evaluate/quantiles.h"

#include <hoist/data/oriented_box.h>

#include <string>
#include <vector>

namespace hoist {

/** \brief Something found, at the first IoU of the settings. */
struct Hit {
  std::size_t scene = 0;
  std::size_t prediction = 0;
  std::size_t truth = 0;
  double iou = 0;
  BoxErrors errors;
};

/** \brief What errors of hits look like; lengths [m], angles [rad]. */
struct ErrorSummary {
  Summary iou;
  Summary center;                   ///< distance of the centres
  Summary size;                     ///< |error| of every side
  Summary rotation;                 ///< modulo symmetry
  std::array<Summary, 3> size_rank; ///< of the largest, middle and smallest true side
  double size_bias = 0;             ///< median of the sides' errors with their sign
};

/** \brief Figures at one threshold of the IoU. */
struct Level {
  double iou = 0;
  Detection detection;
  std::size_t ignored = 0;
};

/** \brief The figures of all things, or of one class. */
struct Group {
  std::string name;
  std::size_t truths = 0; ///< not difficult
  std::size_t difficult = 0;
  std::size_t predictions = 0;
  /// False for a class where predictions name none: which class a wrong box is of is
  /// then not known, and only recall is.
  bool precise = true;
  std::vector<Level> levels; ///< in the order of the settings' IoUs
  ErrorSummary errors;
  Attributes attributes;
};

/** \brief How results change with something about the things. */
struct Breakdown {
  struct Bin {
    double from = 0, to = 0;
    Counts counts; ///< wrong ones only where breakdown.precise
    ErrorSummary errors;
  };
  std::string quantity; ///< "distance" [m], "visible fraction", "faces visible"
  bool precise = false; ///< a wrong box has that quantity, too
  std::vector<Bin> bins;
};

struct Evaluation {
  std::vector<Overlaps> overlaps;                       ///< by scene
  std::vector<std::vector<std::vector<Match>>> matches; ///< by IoU, scene, prediction
  std::vector<Hit> hits;
  Group overall;
  std::vector<Group> classes;    ///< by name; empty where the truth names none
  std::optional<double> mean_ap; ///< over the classes, at the first IoU
  ScoreCalibration scores;
  std::vector<SigmaCalibration>
      sigmas; ///< without quantities of which no sigma is said
  std::vector<Breakdown> breakdowns;
};

Evaluation evaluateScenes(const std::vector<EvaluatedScene>& scenes,
                          const EvaluateSettings& settings);

} // namespace hoist
