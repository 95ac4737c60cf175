#include "evaluate/breakdown.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

namespace hoist {
namespace {

using Quantity = std::function<std::optional<double>(const AnnotatedObject&)>;

std::optional<double>
distanceOf(const AnnotatedObject& truth)
{
  return truth.center.norm();
}

std::optional<double>
fractionOf(const AnnotatedObject& truth)
{
  return truth.visible_fraction;
}

std::optional<double>
facesOf(const AnnotatedObject& truth)
{
  if (!truth.faces_visible)
    return std::nullopt;
  return *truth.faces_visible;
}

// Round steps, at most eight, from the nearest to the furthest thing.
std::vector<double>
distanceEdges(const std::vector<EvaluatedScene>& scenes)
{
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (const EvaluatedScene& scene : scenes)
    for (const AnnotatedObject& truth : scene.truths)
      if (!truth.difficult) {
        low = std::min(low, truth.center.norm());
        high = std::max(high, truth.center.norm());
      }
  std::vector<double> edges;
  if (!(low <= high) || !std::isfinite(high))
    return edges;
  double step = 0.1;
  for (int i = 0; std::floor(high / step) - std::floor(low / step) >= 8; ++i)
    step *= i % 3 == 1 ? 2.5 : 2; // 0.1 0.2 0.5 1 2 5 10
  const double first = std::floor(low / step);
  for (int i = 0; i <= 9; ++i) {
    edges.push_back((first + i) * step);
    if (edges.back() > high)
      break;
  }
  return edges;
}

// The bin [edges[i], edges[i + 1]) of a value; the last one takes its upper edge, too.
std::optional<std::size_t>
binOf(const std::vector<double>& edges, const std::optional<double>& value)
{
  if (!value || *value < edges.front() || *value > edges.back())
    return std::nullopt;
  const auto above = std::upper_bound(edges.begin(), edges.end(), *value);
  return std::min<std::size_t>(above - edges.begin(), edges.size() - 1) - 1;
}

Breakdown
breakdownOf(const std::string& name,
            const std::vector<double>& edges,
            const Quantity& quantity,
            const std::vector<EvaluatedScene>& scenes,
            const Evaluation& evaluation)
{
  Breakdown out;
  out.quantity = name;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    Breakdown::Bin bin;
    bin.from = edges[i];
    bin.to = edges[i + 1];
    out.bins.push_back(bin);
  }
  if (out.bins.empty())
    return out;
  for (const EvaluatedScene& scene : scenes)
    for (const AnnotatedObject& truth : scene.truths)
      if (const auto bin = binOf(edges, quantity(truth)); bin && !truth.difficult)
        ++out.bins[*bin].counts.missed;
  std::vector<std::vector<const Hit*>> hits(out.bins.size());
  for (const Hit& hit : evaluation.hits)
    if (const auto bin = binOf(edges, quantity(scenes[hit.scene].truths[hit.truth]))) {
      hits[*bin].push_back(&hit);
      ++out.bins[*bin].counts.hits;
      --out.bins[*bin].counts.missed;
    }
  for (std::size_t i = 0; i < out.bins.size(); ++i)
    out.bins[i].errors = errorSummary(hits[i], scenes);
  return out;
}

// A wrong box is as far away as it claims to be; beyond the last thing it is counted
// with it.
void
addWrong(Breakdown& distances,
         const std::vector<EvaluatedScene>& scenes,
         const Evaluation& evaluation)
{
  distances.precise = true;
  for (std::size_t s = 0; s < scenes.size(); ++s)
    for (std::size_t i = 0; i < scenes[s].predictions.size(); ++i)
      if (evaluation.matches.front()[s][i].verdict == Verdict::wrong) {
        const double distance = scenes[s].predictions[i].center.norm();
        std::size_t bin = 0;
        while (bin + 1 < distances.bins.size() && distance >= distances.bins[bin].to)
          ++bin;
        ++distances.bins[bin].counts.wrong;
      }
}

} // namespace

ErrorSummary
errorSummary(const std::vector<const Hit*>& hits,
             const std::vector<EvaluatedScene>& scenes)
{
  std::vector<double> iou, center, size, rotation, signed_size;
  std::array<std::vector<double>, 3> ranks;
  for (const Hit* hit : hits) {
    iou.push_back(hit->iou);
    center.push_back(hit->errors.center.norm());
    rotation.push_back(hit->errors.rotation);
    const Eigen::Vector3d& true_size = scenes[hit->scene].truths[hit->truth].size;
    std::array<int, 3> order = {0, 1, 2};
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
      return true_size[a] > true_size[b];
    });
    for (std::size_t i = 0; i < 3; ++i) {
      size.push_back(std::abs(hit->errors.size[static_cast<int>(i)]));
      signed_size.push_back(hit->errors.size[static_cast<int>(i)]);
      ranks[i].push_back(std::abs(hit->errors.size[order[i]]));
    }
  }
  ErrorSummary out;
  out.iou = summaryOf(iou);
  out.center = summaryOf(center);
  out.size = summaryOf(size);
  out.rotation = summaryOf(rotation);
  for (std::size_t i = 0; i < 3; ++i)
    out.size_rank[i] = summaryOf(ranks[i]);
  out.size_bias = summaryOf(signed_size).median;
  return out;
}

std::vector<Breakdown>
breakdownsOf(const std::vector<EvaluatedScene>& scenes, const Evaluation& evaluation)
{
  const auto known = [&](const Quantity& quantity) {
    for (const EvaluatedScene& scene : scenes)
      for (const AnnotatedObject& truth : scene.truths)
        if (!truth.difficult && quantity(truth))
          return true;
    return false;
  };
  std::vector<Breakdown> out;
  const std::vector<double> distances = distanceEdges(scenes);
  if (distances.size() > 1) {
    out.push_back(breakdownOf("distance", distances, distanceOf, scenes, evaluation));
    addWrong(out.back(), scenes, evaluation);
  }
  if (known(fractionOf))
    out.push_back(breakdownOf("visible fraction",
                              {0, 0.2, 0.4, 0.6, 0.8, 0.95, 1},
                              fractionOf,
                              scenes,
                              evaluation));
  if (known(facesOf))
    out.push_back(
        breakdownOf("faces visible", {0, 1, 2, 3, 4, 6}, facesOf, scenes, evaluation));
  return out;
}

} // namespace hoist
