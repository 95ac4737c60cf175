#include "cuboid_judge.h"

#include <hoist/segmentation/cuboid_roundness.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hoist {
namespace detail {
namespace {

constexpr int samples = 1500; // of a close look [px]

// Boxes that differ by less than refinement moves them, whatever their axes are called,
// and whose ends are known alike. Reach: how far refinement looks for an end [m].
bool
alike(const CuboidHypothesis& a, const CuboidHypothesis& b, double reach)
{
  constexpr double tolerance = 0.02; // of the diagonal
  const double gate = std::min(reach, tolerance * a.size().norm());
  if ((a.center() - b.center()).norm() > gate)
    return false;
  for (int i = 0; i < 3; ++i) {
    int j = 0;
    const double cosine = (b.axes.transpose() * a.axes.col(i)).cwiseAbs().maxCoeff(&j);
    constexpr double min_cosine = 0.995;
    if (cosine < min_cosine || std::abs(a.size()[i] - b.size()[j]) > gate)
      return false;
    const bool flip = b.axes.col(j).dot(a.axes.col(i)) < 0;
    if (a.ends[2 * i] != b.ends[2 * j + (flip ? 1 : 0)] ||
        a.ends[2 * i + 1] != b.ends[2 * j + (flip ? 0 : 1)])
      return false;
  }
  return true;
}

} // namespace

void
CuboidJudge::verify(CuboidCandidate& candidate, int max_samples) const
{
  verifyCuboid(candidate.hypothesis,
               images_.inverse_depth,
               images_.bgr,
               labels_,
               faces_,
               images_.intrinsics,
               sensor_,
               max_samples,
               candidate.evidence);
}

// How far apart boxes may be to count as alike: \a steps of a pixel and the noise [m].
double
CuboidJudge::reach(const CuboidHypothesis& h, double steps) const
{
  const Intrinsics& camera = images_.intrinsics;
  const double z = h.center().z();
  return steps * (z / std::min(camera.fx, camera.fy) + sensor_.sigmaZ(z));
}

void
CuboidJudge::judge(std::vector<CuboidCandidate>& candidates)
{
  order_.clear();
  starts_.clear();
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    CuboidCandidate& c = candidates[i];
    starts_.push_back(c.hypothesis);
    glance(c);
    if (!c.rejected)
      order_.push_back(static_cast<int>(i));
  }
  std::sort(order_.begin(), order_.end(), [&](int a, int b) {
    const CuboidEvidence &ea = candidates[a].evidence, &eb = candidates[b].evidence;
    const double va = ea.flat * ea.outline * ea.pixels();
    const double vb = eb.flat * eb.outline * eb.pixels();
    return va > vb || (va == vb && a < b);
  });

  // The promising ones are refined, the best first; a box that starts where one has
  // been refined would end there too.
  done_.clear();
  for (const int i : order_) {
    CuboidCandidate& c = candidates[i];
    const double distance = reach(c.hypothesis, 3);
    const auto same = [&](int k) { return alike(starts_[k], starts_[i], distance); };
    // It shares its room with a box that explains more than it ever could: a short look
    // and refinement change the number of its pixels by less than a fifth.
    constexpr double growth = 1.2;
    const double most = growth * c.evidence.mostValue();
    const auto beaten = [&](int k) {
      const CuboidCandidate& other = candidates[k];
      return !other.rejected && other.evidence.value() > most &&
             excludeEachOther(other.hypothesis, c.hypothesis);
    };
    if (std::any_of(done_.begin(), done_.end(), same))
      c.rejected = "the same as another";
    else if (std::any_of(done_.begin(), done_.end(), beaten))
      c.rejected = "another explains more there";
    else {
      done_.push_back(i);
      judgeClosely(c);
    }
  }
}

// A short look at the last of starts_, none where it can come to nothing.
void
CuboidJudge::glance(CuboidCandidate& c) const
{
  c.evidence.clear();
  c.evidence.stride = 0;
  const double known = trustInEnds(c.hypothesis);
  if (highestScore(known) < parameters_.min_score) {
    c.rejected = "an end is hidden";
    return;
  }
  // refinement moves an end by a few pixels at most
  c.rejected = sizeRejection(c.hypothesis, parameters_, reach(c.hypothesis, 3));
  if (c.rejected)
    return;
  const double distance = reach(c.hypothesis, 1);
  const auto same = [&](const CuboidHypothesis& h) {
    return alike(h, c.hypothesis, distance);
  };
  if (std::any_of(starts_.begin(), starts_.end() - 1, same)) {
    c.rejected = "the same as another";
    return;
  }
  constexpr int quick_samples = 600;
  verify(c, quick_samples);
  const double flat = c.evidence.flat, outline = c.evidence.outline;
  constexpr double min_flat = 0.5, min_outline = 0.4, min_product = 0.15;
  if (flat < min_flat || outline < min_outline ||
      flat * flat * flat * outline * known < min_product)
    c.rejected = "the frame contradicts it";
}

bool
CuboidJudge::refine(CuboidCandidate& c) const
{
  return refineCuboid(c.hypothesis,
                      c.evidence,
                      images_.inverse_depth,
                      labels_,
                      faces_,
                      borders_,
                      images_.intrinsics,
                      sensor_,
                      c.covariance);
}

void
CuboidJudge::judgeClosely(CuboidCandidate& c) const
{
  c.refined = refine(c);
  verify(c, samples);
  // Chosen on rendered tables at 0.8 to 3 m: no box of 606 exceeds 1.05, and of 178
  // others five are below 1.1.
  constexpr double max_roundness = 1.1;
  if (c.evidence.score < parameters_.min_score)
    c.rejected = "score below the minimum";
  else if (const char* reason = sizeRejection(c.hypothesis, parameters_, 0))
    c.rejected = reason;
  else if (cuboidRoundness(
               c.hypothesis, images_.inverse_depth, images_.intrinsics, sensor_) >
           max_roundness)
    c.rejected = "a cylinder explains it better";
}

void
CuboidJudge::judgeFully(CuboidCandidate& c) const
{
  // Its ends are where they belong by now, so that more of the outline is in reach.
  CuboidCandidate again = c;
  if (c.refined && refine(again)) {
    verify(again, samples);
    if (again.evidence.score >= c.evidence.score)
      c = again;
  }
  verify(c, std::numeric_limits<int>::max());
  if (c.evidence.score < parameters_.min_score)
    c.rejected = "score below the minimum";
  else
    c.rejected = sizeRejection(c.hypothesis, parameters_, 0);
}

} // namespace detail
} // namespace hoist
