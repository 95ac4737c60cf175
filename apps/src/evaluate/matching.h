#pragma once

#include "evaluate/scenes.h"

#include <Eigen/Core>

#include <vector>

namespace hoist {

/** \brief How predictions (rows, as in EvaluatedScene) and true things (columns)
 * overlap. Where both name a class and the classes differ, as if they were far apart.
 */
struct Overlaps {
  Eigen::MatrixXd iou;    ///< intersection over union, exact
  Eigen::MatrixXd inside; ///< share of the prediction's volume that lies inside
};

Overlaps overlapsOf(const EvaluatedScene& scene);

enum class Verdict {
  hit,
  wrong,
  ignored ///< belongs to something difficult
};

/** \brief What became of a prediction. */
struct Match {
  Verdict verdict = Verdict::wrong;
  int truth = -1;      ///< which it hit, -1 for none
  int nearest = -1;    ///< the one with the largest overlap, -1 for none
  double best_iou = 0; ///< largest overlap with any
};

/** \brief Judges the predictions of a scene, the highest score first.
 *
 * A prediction is a hit if its IoU with something not difficult that no other has hit
 * reaches \a iou; the largest IoU decides. Else it is ignored if its IoU with something
 * difficult is at least min(iou, ignore_iou), or at least ignore_share of it lies
 * inside of such. Else it is wrong, a second box on the same thing too.
 */
std::vector<Match> matchScene(const EvaluatedScene& scene,
                              const Overlaps& overlaps,
                              double iou,
                              const EvaluateSettings& settings);

} // namespace hoist
