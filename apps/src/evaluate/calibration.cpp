#include "evaluate/calibration.h"

#include "evaluate/quantiles.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hoist {

ScoreCalibration
scoreCalibration(const std::vector<ScoredVerdict>& verdicts)
{
  ScoreCalibration out;
  for (const ScoredVerdict& verdict : verdicts) {
    if (!(verdict.score >= 0 && verdict.score <= 1)) {
      ++out.out_of_range;
      continue;
    }
    const auto last = static_cast<double>(out.bins.size() - 1);
    ScoreBin& bin = out.bins[static_cast<std::size_t>(
        std::min(std::floor(verdict.score * 10), last))];
    ++bin.n;
    bin.hits += verdict.hit ? 1 : 0;
    bin.mean_score += verdict.score;
    const double miss = verdict.score - (verdict.hit ? 1 : 0);
    out.brier += miss * miss;
    ++out.n;
  }
  if (out.n == 0)
    return out;
  out.brier /= static_cast<double>(out.n);
  for (ScoreBin& bin : out.bins)
    if (bin.n > 0) {
      bin.mean_score /= static_cast<double>(bin.n);
      bin.hit_share = static_cast<double>(bin.hits) / static_cast<double>(bin.n);
      out.ece += std::abs(bin.hit_share - bin.mean_score) * static_cast<double>(bin.n) /
                 static_cast<double>(out.n);
    }
  return out;
}

SigmaCalibration
sigmaCalibration(std::string quantity, std::vector<double> ratios)
{
  constexpr double median_of_normal = 0.674489750196; // of |x|, standard deviation 1
  SigmaCalibration out;
  out.quantity = std::move(quantity);
  out.n = ratios.size();
  for (double& ratio : ratios) {
    ratio = std::abs(ratio);
    out.within_1 += ratio <= 1 ? 1 : 0;
    out.within_2 += ratio <= 2 ? 1 : 0;
    out.rms += ratio * ratio;
  }
  if (out.n > 0) {
    const auto n = static_cast<double>(out.n);
    out.within_1 /= n;
    out.within_2 /= n;
    out.rms = std::sqrt(out.rms / n);
  }
  std::sort(ratios.begin(), ratios.end());
  out.factor = quantile(ratios, 0.5) / median_of_normal;
  out.sorted = std::move(ratios);
  return out;
}

} // namespace hoist
