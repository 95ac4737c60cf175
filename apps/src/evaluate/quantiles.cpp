#include "evaluate/quantiles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace hoist {

double
quantile(const std::vector<double>& sorted, double q)
{
  if (sorted.empty())
    return std::numeric_limits<double>::quiet_NaN();
  const double rank = q * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(rank));
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  const double part = rank - static_cast<double>(below);
  return sorted[below] + part * (sorted[above] - sorted[below]);
}

Summary
summaryOf(std::vector<double> numbers)
{
  std::sort(numbers.begin(), numbers.end());
  Summary out;
  out.n = numbers.size();
  out.median = quantile(numbers, 0.5);
  out.p90 = quantile(numbers, 0.9);
  out.p99 = quantile(numbers, 0.99);
  out.max = quantile(numbers, 1);
  out.mean = std::accumulate(numbers.begin(), numbers.end(), 0.0) /
             static_cast<double>(numbers.size());
  return out;
}

} // namespace hoist
