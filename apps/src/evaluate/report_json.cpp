#include "evaluate/report_json.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace hoist {
namespace {

using Json = nlohmann::ordered_json;

Json
number(double value)
{
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json
countsJson(const Counts& counts)
{
  return {{"hits", counts.hits},
          {"wrong", counts.wrong},
          {"missed", counts.missed},
          {"precision", counts.precision()},
          {"recall", counts.recall()},
          {"f1", counts.f1()}};
}

Json
summaryJson(const Summary& summary)
{
  return {{"median", number(summary.median)},
          {"p90", number(summary.p90)},
          {"p99", number(summary.p99)},
          {"max", number(summary.max)},
          {"mean", number(summary.mean)}};
}

Json
errorsJson(const ErrorSummary& errors)
{
  Json out;
  out["n"] = errors.center.n;
  out["iou"] = summaryJson(errors.iou);
  out["center"] = summaryJson(errors.center);
  out["size"] = summaryJson(errors.size);
  out["size_largest"] = summaryJson(errors.size_rank[0]);
  out["size_middle"] = summaryJson(errors.size_rank[1]);
  out["size_smallest"] = summaryJson(errors.size_rank[2]);
  out["size_bias"] = number(errors.size_bias);
  out["rotation"] = summaryJson(errors.rotation);
  return out;
}

Json
levelJson(const Level& level, bool precise)
{
  const Detection& d = level.detection;
  Json out;
  out["iou"] = level.iou;
  out.update(countsJson(d.all));
  out["ignored"] = level.ignored;
  out["ap"] = d.average_precision ? Json(*d.average_precision) : Json(nullptr);
  out["best"] = countsJson(d.best);
  out["best"]["score"] = d.best_score ? Json(*d.best_score) : Json(nullptr);
  if (!precise) // which class a wrong box is of is not known
    for (const char* const key : {"wrong", "precision", "f1", "ap", "best"})
      out[key] = nullptr;
  return out;
}

Json
attributeJson(const AttributeCount& count)
{
  return {{"truths", count.truths}, {"said", count.said}, {"right", count.right}};
}

Json
groupJson(const Group& group)
{
  Json out;
  out["truths"] = group.truths;
  out["difficult"] = group.difficult;
  out["predictions"] = group.predictions;
  out["levels"] = Json::array();
  for (const Level& level : group.levels)
    out["levels"].push_back(levelJson(level, group.precise));
  out["errors"] = errorsJson(group.errors);
  std::vector<double> weights;
  for (const double weight : group.attributes.weight)
    weights.push_back(std::abs(weight));
  out["attributes"] = {{"color", attributeJson(group.attributes.color)},
                       {"material", attributeJson(group.attributes.material)},
                       {"fullness", attributeJson(group.attributes.fullness)},
                       {"weight", summaryJson(summaryOf(weights))}};
  out["attributes"]["weight"]["n"] = weights.size();
  return out;
}

Json
scoresJson(const ScoreCalibration& scores)
{
  Json out;
  out["n"] = scores.n;
  out["out_of_range"] = scores.out_of_range;
  out["ece"] = scores.ece;
  out["brier"] = scores.brier;
  out["bins"] = Json::array();
  for (const ScoreBin& bin : scores.bins)
    out["bins"].push_back({{"n", bin.n},
                           {"hits", bin.hits},
                           {"mean_score", bin.n > 0 ? Json(bin.mean_score) : Json()},
                           {"hit_share", bin.n > 0 ? Json(bin.hit_share) : Json()}});
  return out;
}

Json
sigmasJson(const std::vector<SigmaCalibration>& sigmas)
{
  Json out = Json::array();
  for (const SigmaCalibration& sigma : sigmas)
    out.push_back({{"quantity", sigma.quantity},
                   {"n", sigma.n},
                   {"within_1", sigma.within_1},
                   {"within_2", sigma.within_2},
                   {"rms", sigma.rms},
                   {"factor", number(sigma.factor)}});
  return out;
}

Json
breakdownJson(const Breakdown& breakdown)
{
  Json out;
  out["quantity"] = breakdown.quantity;
  out["bins"] = Json::array();
  for (const Breakdown::Bin& bin : breakdown.bins) {
    Json entry;
    entry["from"] = bin.from;
    entry["to"] = bin.to;
    entry.update(countsJson(bin.counts));
    if (!breakdown.precise)
      for (const char* const key : {"wrong", "precision", "f1"})
        entry[key] = nullptr;
    entry["errors"] = errorsJson(bin.errors);
    out["bins"].push_back(entry);
  }
  return out;
}

const char*
word(Verdict verdict)
{
  return verdict == Verdict::hit     ? "hit"
         : verdict == Verdict::wrong ? "wrong"
                                     : "ignored";
}

Json
sceneJson(const EvaluatedScene& scene,
          std::size_t s,
          const Evaluation& evaluation,
          const std::vector<const Hit*>& hits)
{
  const auto named = [&](int truth) {
    const AnnotatedObject& object = scene.truths[static_cast<std::size_t>(truth)];
    Json out;
    out["truth"] = truth;
    if (object.label > 0)
      out["label"] = object.label;
    if (!object.object_class.empty())
      out["class"] = object.object_class;
    return out;
  };
  Json out;
  out["scene"] = scene.name;
  out["predictions"] = Json::array();
  std::vector<bool> found(scene.truths.size(), false);
  for (std::size_t i = 0; i < scene.predictions.size(); ++i) {
    const Match& match = evaluation.matches.front()[s][i];
    Json entry;
    entry["score"] = scene.predictions[i].score;
    entry["verdict"] = word(match.verdict);
    entry["best_iou"] = match.best_iou;
    if (match.truth >= 0) {
      found[static_cast<std::size_t>(match.truth)] = true;
      entry.update(named(match.truth));
      for (const Hit* hit : hits)
        if (hit->prediction == i) {
          entry["iou"] = hit->iou;
          const Eigen::Vector3d &c = hit->errors.center, &size = hit->errors.size;
          entry["center"] = {c.x(), c.y(), c.z()};
          entry["size"] = {size.x(), size.y(), size.z()};
          entry["rotation"] = hit->errors.rotation;
        }
    }
    out["predictions"].push_back(entry);
  }
  out["missed"] = Json::array();
  for (std::size_t j = 0; j < scene.truths.size(); ++j)
    if (!found[j] && !scene.truths[j].difficult)
      out["missed"].push_back(named(static_cast<int>(j)));
  return out;
}

} // namespace

std::string
evaluationJson(const std::vector<EvaluatedScene>& scenes,
               const Evaluation& evaluation,
               const EvaluateSettings& settings)
{
  Json out;
  out["settings"] = {{"of", settings.of},
                     {"iou", settings.ious},
                     {"min_score", settings.min_score},
                     {"ignore_iou", settings.ignore_iou},
                     {"ignore_share", settings.ignore_share},
                     {"color_tolerance", settings.color_tolerance}};
  out["scenes"] = scenes.size();
  out["overall"] = groupJson(evaluation.overall);
  out["classes"] = Json::object();
  for (const Group& group : evaluation.classes)
    out["classes"][group.name] = groupJson(group);
  out["mean_ap"] = evaluation.mean_ap ? Json(*evaluation.mean_ap) : Json(nullptr);
  out["breakdowns"] = Json::array();
  for (const Breakdown& breakdown : evaluation.breakdowns)
    out["breakdowns"].push_back(breakdownJson(breakdown));
  out["scores"] = scoresJson(evaluation.scores);
  out["sigmas"] = sigmasJson(evaluation.sigmas);
  out["details"] = Json::array();
  std::vector<std::vector<const Hit*>> hits(scenes.size());
  for (const Hit& hit : evaluation.hits)
    hits[hit.scene].push_back(&hit);
  for (std::size_t s = 0; s < scenes.size(); ++s)
    out["details"].push_back(sceneJson(scenes[s], s, evaluation, hits[s]));
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace hoist
