#include "evaluate/evaluation.h"

#include "evaluate/breakdown.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace hoist {
namespace {

using Scenes = std::vector<EvaluatedScene>;

std::vector<Hit>
hitsOf(const Scenes& scenes, const Evaluation& evaluation)
{
  std::vector<Hit> hits;
  for (std::size_t s = 0; s < scenes.size(); ++s)
    for (std::size_t i = 0; i < scenes[s].predictions.size(); ++i) {
      const Match& match = evaluation.matches.front()[s][i];
      if (match.verdict != Verdict::hit)
        continue;
      const Prediction& prediction = scenes[s].predictions[i];
      const AnnotatedObject& truth = scenes[s].truths[match.truth];
      const OrientedBox box(prediction.center, prediction.size, prediction.rotation);
      hits.push_back(
          {s,
           i,
           static_cast<std::size_t>(match.truth),
           evaluation.overlaps[s].iou(static_cast<Eigen::Index>(i), match.truth),
           boxErrors(box, OrientedBox(truth), truth.symmetry)});
    }
  return hits;
}

// The class of a prediction; where it names none, that of what it hit or lies on.
std::string
classOf(const EvaluatedScene& scene, std::size_t prediction, const Match& match)
{
  const std::string& own = scene.predictions[prediction].object_class;
  if (!own.empty())
    return own;
  const int truth = match.truth >= 0                    ? match.truth
                    : match.verdict == Verdict::ignored ? match.nearest
                                                        : -1;
  return truth >= 0 ? scene.truths[truth].object_class : "";
}

// \param of nothing for all, or a class
Group
groupOf(const Scenes& scenes,
        const Evaluation& evaluation,
        const EvaluateSettings& settings,
        const std::optional<std::string>& of)
{
  Group group;
  group.name = of.value_or("overall");
  for (const EvaluatedScene& scene : scenes) {
    for (const AnnotatedObject& truth : scene.truths)
      if (!of || truth.object_class == *of)
        ++(truth.difficult ? group.difficult : group.truths);
    if (of)
      for (const Prediction& prediction : scene.predictions)
        group.precise = group.precise && !prediction.object_class.empty();
  }
  for (std::size_t level = 0; level < settings.ious.size(); ++level) {
    std::vector<ScoredVerdict> verdicts;
    Level out;
    out.iou = settings.ious[level];
    std::size_t predictions = 0;
    for (std::size_t s = 0; s < scenes.size(); ++s)
      for (std::size_t i = 0; i < scenes[s].predictions.size(); ++i) {
        const Match& match = evaluation.matches[level][s][i];
        if (of && classOf(scenes[s], i, match) != *of)
          continue;
        ++predictions;
        if (match.verdict == Verdict::ignored)
          ++out.ignored;
        else
          verdicts.push_back(
              {scenes[s].predictions[i].score, match.verdict == Verdict::hit});
      }
    if (level == 0)
      group.predictions = predictions;
    out.detection = detectionOf(std::move(verdicts), group.truths);
    group.levels.push_back(std::move(out));
  }
  std::vector<const Hit*> hits;
  for (const Hit& hit : evaluation.hits) {
    const AnnotatedObject& truth = scenes[hit.scene].truths[hit.truth];
    if (of && truth.object_class != *of)
      continue;
    hits.push_back(&hit);
    group.attributes.add(
        scenes[hit.scene].predictions[hit.prediction], truth, settings.color_tolerance);
  }
  group.errors = errorSummary(hits, scenes);
  return group;
}

ScoreCalibration
calibratedScores(const Scenes& scenes, const Evaluation& evaluation)
{
  std::vector<ScoredVerdict> verdicts;
  for (std::size_t s = 0; s < scenes.size(); ++s)
    for (std::size_t i = 0; i < scenes[s].predictions.size(); ++i) {
      const Match& match = evaluation.matches.front()[s][i];
      if (match.verdict != Verdict::ignored)
        verdicts.push_back(
            {scenes[s].predictions[i].score, match.verdict == Verdict::hit});
    }
  return scoreCalibration(verdicts);
}

// Ratios by quantity, in a fixed order.
class Ratios {
public:
  void
  add(const std::string& quantity, double error, double sigma)
  {
    if (!(sigma > 0) || !std::isfinite(sigma) || !std::isfinite(error))
      return;
    for (auto& [name, ratios] : all_)
      if (name == quantity) {
        ratios.push_back(error / sigma);
        return;
      }
    all_.emplace_back(quantity, std::vector<double>{error / sigma});
  }

  std::vector<SigmaCalibration>
  calibrations(const std::vector<std::string>& order)
  {
    std::vector<SigmaCalibration> out;
    for (const std::string& quantity : order)
      for (auto& [name, ratios] : all_)
        if (name == quantity)
          out.push_back(sigmaCalibration(name, std::move(ratios)));
    return out;
  }

private:
  std::vector<std::pair<std::string, std::vector<double>>> all_;
};

std::vector<SigmaCalibration>
calibratedSigmas(const Scenes& scenes, const Evaluation& evaluation)
{
  Ratios ratios;
  for (const Hit& hit : evaluation.hits) {
    const Prediction& found = scenes[hit.scene].predictions[hit.prediction];
    const AnnotatedObject& truth = scenes[hit.scene].truths[hit.truth];
    for (int i = 0; i < 3; ++i) {
      ratios.add("centre", hit.errors.center[i], found.center_sigma[i]);
      const int axis = hit.errors.axis[static_cast<std::size_t>(i)];
      const std::string& source =
          found.dimension_source[static_cast<std::size_t>(axis)];
      ratios.add(source.empty() || source == "measured" ? "side" : "side, " + source,
                 hit.errors.size[i],
                 found.size_sigma[axis]);
    }
    ratios.add("rotation", hit.errors.rotation, found.rotation_sigma);
    if (truth.weight && found.weight)
      ratios.add("weight", *found.weight - *truth.weight, found.weight_sigma);
  }
  return ratios.calibrations({"centre",
                              "side",
                              "side, support",
                              "side, bracketed",
                              "side, partial",
                              "side, catalogue",
                              "side, unknown",
                              "rotation",
                              "weight"});
}

} // namespace

Evaluation
evaluateScenes(const Scenes& scenes, const EvaluateSettings& settings)
{
  Evaluation out;
  for (const EvaluatedScene& scene : scenes)
    out.overlaps.push_back(overlapsOf(scene));
  for (const double iou : settings.ious) {
    out.matches.emplace_back();
    for (std::size_t s = 0; s < scenes.size(); ++s)
      out.matches.back().push_back(
          matchScene(scenes[s], out.overlaps[s], iou, settings));
  }
  out.hits = hitsOf(scenes, out);
  out.overall = groupOf(scenes, out, settings, std::nullopt);

  std::set<std::string> classes;
  for (const EvaluatedScene& scene : scenes) {
    for (const AnnotatedObject& truth : scene.truths)
      classes.insert(truth.object_class);
    for (const Prediction& prediction : scene.predictions)
      classes.insert(prediction.object_class);
  }
  classes.erase("");
  double sum = 0;
  std::size_t n = 0;
  for (const std::string& name : classes) {
    out.classes.push_back(groupOf(scenes, out, settings, name));
    const Detection& detection = out.classes.back().levels.front().detection;
    if (out.classes.back().precise && detection.average_precision) {
      sum += *detection.average_precision;
      ++n;
    }
  }
  if (n > 0)
    out.mean_ap = sum / static_cast<double>(n);
  out.scores = calibratedScores(scenes, out);
  out.sigmas = calibratedSigmas(scenes, out);
  out.breakdowns = breakdownsOf(scenes, out);
  return out;
}

} // namespace hoist
