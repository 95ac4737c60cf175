#pragma once

#include "evaluate/detection.h"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace hoist {

/** \brief Predictions whose score lies in one tenth of [0, 1]. */
struct ScoreBin {
  std::size_t n = 0;
  std::size_t hits = 0;
  double mean_score = 0; ///< 0 without predictions
  double hit_share = 0;  ///< hits / n; equals mean_score where scores are probabilities
};

/** \brief Whether a score says how likely a prediction is a hit. */
struct ScoreCalibration {
  std::size_t n = 0;             ///< predictions, ignored ones left out
  std::size_t out_of_range = 0;  ///< scores outside of [0, 1], not in any bin
  std::array<ScoreBin, 10> bins; ///< [0, 0.1), ... [0.9, 1]
  double ece = 0;   ///< expected calibration error: mean of |hit_share - mean_score|,
                    ///< weighted by n
  double brier = 0; ///< mean of (score - hit)^2; 0.25 is what knowing nothing gives
};

ScoreCalibration scoreCalibration(const std::vector<ScoredVerdict>& verdicts);

/** \brief Whether errors of one quantity are as large as their sigmas say. */
struct SigmaCalibration {
  std::string quantity;
  std::size_t n = 0;
  double within_1 = 0; ///< share with |error| <= sigma; 0.683 of a normal distribution
  double within_2 = 0; ///< share with |error| <= 2 sigma; 0.954
  double rms = 0;      ///< root mean square of error / sigma; 1
  double factor = 0;   ///< median |error / sigma| / 0.6745: how many times larger sigma
                       ///< would have to be; 1, and not moved by outliers
  std::vector<double> sorted; ///< |error / sigma|, ascending
};

/** \param ratios error / sigma, of either sign */
SigmaCalibration sigmaCalibration(std::string quantity, std::vector<double> ratios);

} // namespace hoist
