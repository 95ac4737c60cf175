#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace hoist {

/** \brief Hits, wrong boxes and misses, and what follows from them. */
struct Counts {
  std::size_t hits = 0;
  std::size_t wrong = 0;
  std::size_t missed = 0;

  double precision() const; ///< hits / (hits + wrong), 0 without any
  double recall() const;    ///< hits / (hits + missed), 0 without any
  double f1() const;        ///< harmonic mean of both, 0 without hits
};

struct ScoredVerdict {
  double score = 0;
  bool hit = false;
};

/** \brief How well things were found, at one threshold of the IoU. */
struct Detection {
  Counts all; ///< of all predictions
  /// 11-point average precision: the mean over the recalls r = 0, 0.1, ... 1 of the
  /// highest precision at any recall >= r (0 where r is not reached), as the
  /// predictions are taken from the highest score down (Manning et al. 2008). Nothing
  /// without truth.
  std::optional<double> average_precision;
  Counts best; ///< of the predictions with a score >= best_score: the highest F1
  std::optional<double> best_score;
  std::vector<std::array<double, 2>> curve; ///< recall and precision, prediction by
                                            ///< prediction
};

/** \param verdicts those of equal score count in this order
 *  \param truths how many things there were to be found */
Detection detectionOf(std::vector<ScoredVerdict> verdicts, std::size_t truths);

} // namespace hoist
