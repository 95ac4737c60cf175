#include <hoist/segmentation/cuboid_selection.h>

#include <algorithm>
#include <cmath>

namespace hoist {
namespace {

// Share of a's volume inside b, from a regular grid of points in a.
double
volumeShare(const CuboidHypothesis& a, const CuboidHypothesis& b)
{
  constexpr int n = 6;
  int inside = 0;
  const Eigen::Matrix3d turn = b.axes.transpose() * a.axes;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        const Eigen::Vector3d t((i + 0.5) / n, (j + 0.5) / n, (k + 0.5) / n);
        const Eigen::Vector3d p = turn * (a.lower + t.cwiseProduct(a.size()));
        inside +=
            (p.array() > b.lower.array()).all() && (p.array() < b.upper.array()).all();
      }
  return inside / static_cast<double>(n * n * n);
}

} // namespace

bool
excludeEachOther(const CuboidHypothesis& a, const CuboidHypothesis& b)
{
  const double reach = a.size().norm() + b.size().norm();
  if ((a.center() - b.center()).norm() > reach / 2)
    return false;
  constexpr double max_share = 0.25;
  return volumeShare(a, b) > max_share || volumeShare(b, a) > max_share;
}

void
selectCuboids(std::vector<CuboidCandidate>& candidates, std::vector<int>& chosen)
{
  chosen.clear();
  std::vector<int> order;
  std::vector<double> value(candidates.size());
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    value[i] = candidates[i].evidence.value();
    if (!candidates[i].rejected)
      order.push_back(static_cast<int>(i));
  }
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return value[a] > value[b] || (value[a] == value[b] && a < b);
  });

  const std::size_t n = order.size();
  std::vector<char> clash(n * n, 0);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j)
      clash[i * n + j] = clash[j * n + i] =
          excludeEachOther(candidates[order[i]].hypothesis,
                           candidates[order[j]].hypothesis)
              ? 1
              : 0;

  std::vector<char> in(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    bool free = true;
    for (std::size_t j = 0; j < i && free; ++j)
      free = in[j] == 0 || clash[i * n + j] == 0;
    in[i] = free ? 1 : 0;
  }
  // exchanges: one in, all that clash with it out
  for (bool better = true; better;) {
    better = false;
    for (std::size_t i = 0; i < n; ++i) {
      if (in[i] != 0)
        continue;
      double lost = 0;
      for (std::size_t j = 0; j < n; ++j)
        if (in[j] != 0 && clash[i * n + j] != 0)
          lost += value[order[j]];
      if (value[order[i]] > lost + 1e-9) {
        for (std::size_t j = 0; j < n; ++j)
          if (clash[i * n + j] != 0)
            in[j] = 0;
        in[i] = 1;
        better = true;
      }
    }
  }
  for (std::size_t i = 0; i < n; ++i)
    if (in[i] != 0)
      chosen.push_back(order[i]);
    else
      candidates[order[i]].rejected = "another explains more there";
  std::sort(chosen.begin(), chosen.end(), [&](int a, int b) {
    const double sa = candidates[a].evidence.score, sb = candidates[b].evidence.score;
    return sa > sb || (sa == sb && a < b);
  });
}

} // namespace hoist
