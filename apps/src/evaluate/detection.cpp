#include "evaluate/detection.h"

#include <algorithm>

namespace hoist {
namespace {

double
ratio(std::size_t part, std::size_t other)
{
  return part + other == 0
             ? 0
             : static_cast<double>(part) / static_cast<double>(part + other);
}

double
elevenPoints(const std::vector<std::array<double, 2>>& curve)
{
  double sum = 0;
  for (int i = 0; i <= 10; ++i) {
    const double level = i / 10.0 - 1e-12; // 3 of 10 is a recall of 0.3
    double best = 0;
    for (const auto& [recall, precision] : curve)
      if (recall >= level)
        best = std::max(best, precision);
    sum += best;
  }
  return sum / 11;
}

} // namespace

double
Counts::precision() const
{
  return ratio(hits, wrong);
}

double
Counts::recall() const
{
  return ratio(hits, missed);
}

double
Counts::f1() const
{
  const double p = precision(), r = recall();
  return p + r > 0 ? 2 * p * r / (p + r) : 0;
}

Detection
detectionOf(std::vector<ScoredVerdict> verdicts, std::size_t truths)
{
  std::stable_sort(verdicts.begin(), verdicts.end(), [](const auto& a, const auto& b) {
    return a.score > b.score;
  });
  Detection out;
  out.all.missed = truths;
  Counts counts = out.all;
  double best_f1 = -1;
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    if (verdicts[i].hit) {
      ++counts.hits;
      --counts.missed;
    }
    else
      ++counts.wrong;
    out.curve.push_back({counts.recall(), counts.precision()});
    // a threshold lies between different scores only
    const bool last =
        i + 1 == verdicts.size() || verdicts[i + 1].score < verdicts[i].score;
    if (truths > 0 && last && counts.f1() > best_f1) {
      best_f1 = counts.f1();
      out.best = counts;
      out.best_score = verdicts[i].score;
    }
  }
  out.all = counts;
  if (!out.best_score)
    out.best = out.all;
  if (truths > 0)
    out.average_precision = elevenPoints(out.curve);
  return out;
}

} // namespace hoist
