#include "evaluate/report_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace hoist {
namespace {

constexpr double degrees = 180 / 3.14159265358979323846;

std::string
share(std::size_t part, std::size_t whole)
{
  return whole == 0 ? "-"
                    : fmt::format("{:.1f} %",
                                  100.0 * static_cast<double>(part) /
                                      static_cast<double>(whole));
}

std::string
cell(double value, const char* format = "{:.3f}")
{
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "-";
}

std::size_t
nameWidth(const Evaluation& evaluation)
{
  std::size_t width = 12;
  for (const Group& group : evaluation.classes)
    width = std::max(width, group.name.size());
  return width;
}

std::string
detectionRow(const Group& group, const Level& level, std::size_t width)
{
  const Detection& d = level.detection;
  const Counts& all = d.all;
  std::string row =
      fmt::format("{:<{}}  {:>6} {:>6} ", group.name, width, group.truths, all.hits);
  if (!group.precise) // which class a wrong box is of is not known
    return row + fmt::format("{:>6} {:>6} {:>7}   {:>9} {:>6} {:>6}  {:>6}\n",
                             "-",
                             all.missed,
                             level.ignored,
                             "-",
                             cell(all.recall()),
                             "-",
                             "-");
  row += fmt::format("{:>6} {:>6} {:>7}   {:>9} {:>6} {:>6}  {:>6}",
                     all.wrong,
                     all.missed,
                     level.ignored,
                     cell(all.precision()),
                     cell(all.recall()),
                     cell(all.f1()),
                     d.average_precision ? cell(*d.average_precision) : "-");
  if (d.best_score)
    row += fmt::format("   {} (score >= {:.3g})", cell(d.best.f1()), *d.best_score);
  return row + "\n";
}

std::string
detectionText(const Evaluation& evaluation)
{
  const std::size_t width = nameWidth(evaluation);
  std::string text;
  for (std::size_t i = 0; i < evaluation.overall.levels.size(); ++i) {
    text += fmt::format("\nFound at a 3D IoU of at least {:g}\n",
                        evaluation.overall.levels[i].iou);
    text += fmt::format("{:<{}}  {:>6} {:>6} {:>6} {:>6} {:>7}   {:>9} {:>6} {:>6}  "
                        "{:>6}   {}\n",
                        "",
                        width,
                        "truth",
                        "hits",
                        "wrong",
                        "missed",
                        "ignored",
                        "precision",
                        "recall",
                        "F1",
                        "AP",
                        "best F1");
    text += detectionRow(evaluation.overall, evaluation.overall.levels[i], width);
    for (const Group& group : evaluation.classes)
      text += detectionRow(group, group.levels[i], width);
    if (i == 0 && evaluation.mean_ap && evaluation.classes.size() > 1)
      text += fmt::format("mean AP of the classes: {:.3f}\n", *evaluation.mean_ap);
  }
  return text;
}

std::string
summaryRow(const std::string& name, const Summary& s, double scale, int digits)
{
  return fmt::format("{:<28} {:>9.{}f} {:>9.{}f} {:>9.{}f} {:>9.{}f}\n",
                     name,
                     scale * s.median,
                     digits,
                     scale * s.p90,
                     digits,
                     scale * s.p99,
                     digits,
                     scale * s.max,
                     digits);
}

std::string
errorsText(const Group& group)
{
  const ErrorSummary& e = group.errors;
  if (e.center.n == 0)
    return "";
  std::string text = fmt::format("\nErrors of the {} hits\n{:<28} {:>9} {:>9} {:>9} "
                                 "{:>9}\n",
                                 e.center.n,
                                 "",
                                 "median",
                                 "90 %",
                                 "99 %",
                                 "largest");
  text += summaryRow("centre [mm]", e.center, 1000, 1);
  text += summaryRow("every side [mm]", e.size, 1000, 1);
  const char* const ranks[] = {
      "  the largest side [mm]", "  the middle side [mm]", "  the smallest side [mm]"};
  for (std::size_t i = 0; i < 3; ++i)
    text += summaryRow(ranks[i], e.size_rank[i], 1000, 1);
  text += summaryRow("rotation [degrees]", e.rotation, degrees, 2);
  text += fmt::format("median IoU {:.3f}; sides are {:.1f} mm too {} (median)\n",
                      e.iou.median,
                      1000 * std::abs(e.size_bias),
                      e.size_bias < 0 ? "short" : "long");
  return text;
}

std::string
attributeCells(const AttributeCount& count)
{
  if (count.truths == 0)
    return fmt::format("{:>18}", "-");
  return count.said == 0 ? fmt::format("{:>18}", "not said")
                         : fmt::format("{:>8} ({}/{})",
                                       share(count.right, count.truths),
                                       count.right,
                                       count.truths);
}

std::string
attributesText(const Evaluation& evaluation, double tolerance)
{
  const Attributes& all = evaluation.overall.attributes;
  if (all.color.truths + all.material.truths + all.fullness.truths == 0 &&
      all.weight.empty())
    return "";
  const std::size_t width = nameWidth(evaluation);
  std::string text =
      fmt::format("\nAttributes of the hits (right, of those whose truth is known)\n"
                  "{:<{}}  {:>18}  {:>18}  {:>18}\n",
                  "",
                  width,
                  fmt::format("colour +-{:g} %", 100 * tolerance),
                  "material",
                  "fullness");
  const auto row = [&](const Group& group) {
    const Attributes& a = group.attributes;
    text += fmt::format("{:<{}}  {:>18}  {:>18}  {:>18}\n",
                        group.name,
                        width,
                        attributeCells(a.color),
                        attributeCells(a.material),
                        attributeCells(a.fullness));
  };
  row(evaluation.overall);
  for (const Group& group : evaluation.classes)
    row(group);
  if (!all.weight.empty()) {
    std::vector<double> errors;
    for (const double w : all.weight)
      errors.push_back(std::abs(w));
    const Summary s = summaryOf(errors);
    text += fmt::format("weight: {} known, off by {:.1f} % (median), {:.1f} % (90 %)\n",
                        s.n,
                        100 * s.median,
                        100 * s.p90);
  }
  return text;
}

std::string
scoresText(const ScoreCalibration& scores)
{
  if (scores.n == 0)
    return "";
  std::string text = fmt::format(
      "\nScores against the share of hits: expected calibration error {:.3f}, Brier "
      "{:.3f}, of {}\n{:<12} {:>6} {:>12} {:>14}\n",
      scores.ece,
      scores.brier,
      scores.n,
      "score",
      "boxes",
      "mean score",
      "share of hits");
  for (std::size_t i = 0; i < scores.bins.size(); ++i)
    if (const ScoreBin& bin = scores.bins[i]; bin.n > 0)
      text += fmt::format("{:.1f} to {:.1f}   {:>6} {:>12.3f} {:>14.3f}\n",
                          0.1 * static_cast<double>(i),
                          0.1 * static_cast<double>(i + 1),
                          bin.n,
                          bin.mean_score,
                          bin.hit_share);
  if (scores.out_of_range > 0)
    text +=
        fmt::format("{} scores outside of 0 to 1 are in no bin\n", scores.out_of_range);
  return text;
}

std::string
sigmasText(const std::vector<SigmaCalibration>& sigmas)
{
  if (sigmas.empty())
    return "";
  std::string text = fmt::format(
      "\nErrors against the sigmas that were said (normal errors: 68.3 %, 95.4 %, 1, "
      "1)\n{:<18} {:>6} {:>15} {:>15} {:>8} {:>8}\n",
      "",
      "n",
      "within 1 sigma",
      "within 2 sigma",
      "rms",
      "factor");
  for (const SigmaCalibration& s : sigmas)
    text += fmt::format("{:<18} {:>6} {:>13.1f} % {:>13.1f} % {:>8.2f} {:>8.2f}\n",
                        s.quantity,
                        s.n,
                        100 * s.within_1,
                        100 * s.within_2,
                        s.rms,
                        s.factor);
  return text;
}

std::string
breakdownText(const Breakdown& breakdown)
{
  const bool faces = breakdown.quantity == "faces visible";
  std::string text = fmt::format(
      "\nBy {}{}\n{:<12} {:>6} {:>6} {:>6} {:>7} {:>7} {:>12} {:>10} {:>12}\n",
      breakdown.quantity,
      breakdown.quantity == "distance" ? " [m]" : "",
      "",
      "truth",
      "hits",
      "wrong",
      "recall",
      "F1",
      "centre [mm]",
      "side [mm]",
      "rotation [d]");
  for (const Breakdown::Bin& bin : breakdown.bins) {
    const Counts& c = bin.counts;
    if (c.hits + c.missed + c.wrong == 0)
      continue;
    const std::string name =
        faces ? fmt::format("{:g}{}", bin.from, bin.from > 3 ? "+" : "")
              : fmt::format("{:g} to {:g}", bin.from, bin.to);
    text += fmt::format("{:<12} {:>6} {:>6} {:>6} {:>7} {:>7} {:>12} {:>10} {:>12}\n",
                        name,
                        c.hits + c.missed,
                        c.hits,
                        breakdown.precise ? std::to_string(c.wrong) : "-",
                        c.hits + c.missed == 0 ? "-" : cell(c.recall()),
                        breakdown.precise ? cell(c.f1()) : "-",
                        cell(1000 * bin.errors.center.median, "{:.1f}"),
                        cell(1000 * bin.errors.size.median, "{:.1f}"),
                        cell(degrees * bin.errors.rotation.median, "{:.2f}"));
  }
  return text;
}

std::string
truthName(const AnnotatedObject& truth, std::size_t index)
{
  std::string name = truth.object_class.empty() ? "thing" : truth.object_class;
  name += truth.label > 0 ? fmt::format(" with label {}", truth.label)
                          : fmt::format(" number {}", index + 1);
  return name;
}

std::string
boxText(const Eigen::Vector3d& size, const Eigen::Vector3d& center)
{
  return fmt::format("{:.1f} x {:.1f} x {:.1f} cm at {:.3f} {:.3f} {:.3f} m",
                     100 * size[0],
                     100 * size[1],
                     100 * size[2],
                     center[0],
                     center[1],
                     center[2]);
}

} // namespace

std::string
evaluationText(const std::vector<EvaluatedScene>& scenes,
               const Evaluation& evaluation,
               const EvaluateSettings& settings)
{
  const Group& all = evaluation.overall;
  std::string text =
      fmt::format("{} scene{}: {} thing{} to be found, {} difficult, {} prediction{}\n",
                  scenes.size(),
                  scenes.size() == 1 ? "" : "s",
                  all.truths,
                  all.truths == 1 ? "" : "s",
                  all.difficult,
                  all.predictions,
                  all.predictions == 1 ? "" : "s");
  text += detectionText(evaluation);
  text += errorsText(all);
  for (const Breakdown& breakdown : evaluation.breakdowns)
    text += breakdownText(breakdown);
  text += attributesText(evaluation, settings.color_tolerance);
  text += scoresText(evaluation.scores);
  text += sigmasText(evaluation.sigmas);
  return text;
}

std::string
missesText(const std::vector<EvaluatedScene>& scenes, const Evaluation& evaluation)
{
  std::string text;
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    const EvaluatedScene& scene = scenes[s];
    std::vector<bool> found(scene.truths.size(), false);
    std::string lines;
    for (const Match& match : evaluation.matches.front()[s])
      if (match.truth >= 0)
        found[static_cast<std::size_t>(match.truth)] = true;
    for (std::size_t j = 0; j < scene.truths.size(); ++j)
      if (!found[j] && !scene.truths[j].difficult) {
        const double best = scene.predictions.empty()
                                ? 0
                                : evaluation.overlaps[s]
                                      .iou.col(static_cast<Eigen::Index>(j))
                                      .maxCoeff();
        lines += fmt::format("  missed  {}, {}; best IoU {:.2f}\n",
                             truthName(scene.truths[j], j),
                             boxText(scene.truths[j].size, scene.truths[j].center),
                             best);
      }
    for (std::size_t i = 0; i < scene.predictions.size(); ++i) {
      const Match& match = evaluation.matches.front()[s][i];
      if (match.verdict != Verdict::wrong)
        continue;
      const Prediction& p = scene.predictions[i];
      lines += fmt::format(
          "  wrong   {}, {}, score {:.2f}; {}\n",
          p.object_class.empty() ? "box" : p.object_class,
          boxText(p.size, p.center),
          p.score,
          match.nearest < 0
              ? "on nothing"
              : fmt::format("IoU {:.2f} with {}",
                            match.best_iou,
                            truthName(scene.truths[match.nearest],
                                      static_cast<std::size_t>(match.nearest))));
    }
    if (!lines.empty())
      text += scene.name + "\n" + lines;
  }
  return text.empty() ? "\nNothing is missed, no box is wrong\n" : "\n" + text;
}

} // namespace hoist
