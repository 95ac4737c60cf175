#include "evaluate/matching.h"

#include <hoist/data/oriented_box.h>

#include <algorithm>

namespace hoist {
namespace {

bool
comparable(const Prediction& prediction, const AnnotatedObject& truth)
{
  return prediction.object_class.empty() || truth.object_class.empty() ||
         prediction.object_class == truth.object_class;
}

} // namespace

Overlaps
overlapsOf(const EvaluatedScene& scene)
{
  const auto rows = static_cast<Eigen::Index>(scene.predictions.size());
  const auto columns = static_cast<Eigen::Index>(scene.truths.size());
  std::vector<OrientedBox> truths;
  truths.reserve(scene.truths.size());
  for (const AnnotatedObject& truth : scene.truths)
    truths.emplace_back(truth);
  Overlaps out;
  out.iou.setZero(rows, columns);
  out.inside.setZero(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const Prediction& prediction = scene.predictions[i];
    const OrientedBox box(prediction.center, prediction.size, prediction.rotation);
    for (Eigen::Index j = 0; j < columns; ++j)
      if (comparable(prediction, scene.truths[j])) {
        const double shared = intersectionVolume(box, truths[j]);
        out.iou(i, j) = shared / (box.volume() + truths[j].volume() - shared);
        out.inside(i, j) = shared / box.volume();
      }
  }
  return out;
}

std::vector<Match>
matchScene(const EvaluatedScene& scene,
           const Overlaps& overlaps,
           double iou,
           const EvaluateSettings& settings)
{
  const int n = static_cast<int>(scene.truths.size());
  const double ignore_iou = std::min(iou, settings.ignore_iou);
  std::vector<bool> taken(scene.truths.size(), false);
  std::vector<Match> matches;
  for (int i = 0; i < static_cast<int>(scene.predictions.size()); ++i) {
    Match match;
    bool of_difficult = false;
    for (int j = 0; j < n; ++j) {
      const double shared = overlaps.iou(i, j);
      if (shared > match.best_iou) {
        match.best_iou = shared;
        match.nearest = j;
      }
      if (scene.truths[j].difficult)
        of_difficult = of_difficult || shared >= ignore_iou ||
                       overlaps.inside(i, j) >= settings.ignore_share;
      else if (!taken[j] && shared >= iou &&
               (match.truth < 0 || shared > overlaps.iou(i, match.truth)))
        match.truth = j;
    }
    if (match.truth >= 0) {
      match.verdict = Verdict::hit;
      taken[match.truth] = true;
    }
    else if (of_difficult)
      match.verdict = Verdict::ignored;
    matches.push_back(match);
  }
  return matches;
}

} // namespace hoist
