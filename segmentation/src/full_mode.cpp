#include <hoist/segmentation/full_mode.h>

#include "cuboid_judge.h"
#include "cuboid_view.h"
#include "to_cuboid.h"

#include <hoist/segmentation/cuboid_hypotheses.h>
#include <hoist/segmentation/cuboid_selection.h>
#include <hoist/segmentation/face_borders.h>
#include <hoist/segmentation/planar_faces.h>

#include <algorithm>

namespace hoist {

struct FullMode::Workspace {
  Intrinsics camera;
  SensorModel sensor; // with the frame's own scale of noise
  PlanarFaceFinder finder;
  cv::Mat1s labels;
  std::vector<PlanarFace> faces;
  FaceBorders borders;
  std::vector<CuboidHypothesis> hypotheses;
  std::vector<CuboidCandidate> candidates;
  std::vector<int> chosen;

  // Of the candidates for which wanted is true, the best first.
  template <typename Wanted>
  std::vector<CuboidVerdict>
  verdicts(const FrameImages& images, const Wanted& wanted) const
  {
    std::vector<CuboidVerdict> all;
    for (const CuboidCandidate& candidate : candidates) {
      if (!wanted(candidate))
        continue;
      CuboidCandidate c = candidate;
      if (c.evidence.stride == 0) { // nobody has looked at it yet
        constexpr int samples = 600;
        verifyCuboid(c.hypothesis,
                     images.inverse_depth,
                     images.bgr,
                     labels,
                     faces,
                     camera,
                     sensor,
                     samples,
                     c.evidence);
      }
      all.push_back({detail::toCuboid(c),
                     c.rejected ? c.rejected : "",
                     c.evidence.flat,
                     c.evidence.outline,
                     c.evidence.trust});
    }
    std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
      return a.rank() > b.rank();
    });
    return all;
  }
};

bool
FullModeParameters::valid() const
{
  return BoxSizes::valid() && min_score >= 0 && min_score <= 1 && max_cuboids >= 0 &&
         (!support_plane ||
          (support_plane->allFinite() && support_plane->head<3>().norm() > 0));
}

FullMode::FullMode() : workspace_(std::make_unique<Workspace>()) {}
FullMode::~FullMode() = default;
FullMode::FullMode(FullMode&&) noexcept = default;
FullMode& FullMode::operator=(FullMode&&) noexcept = default;

bool
FullMode::segment(const FrameImages& images,
                  const cv::Mat1b& mask,
                  const FullModeParameters& parameters,
                  std::vector<Cuboid>& cuboids,
                  Diagnostics& diagnostics)
{
  Workspace& w = *workspace_;
  cuboids.clear();
  if (!images.intrinsics.valid()) {
    w.labels.release();
    w.candidates.clear();
    return false;
  }
  findFaces(images, mask, parameters, diagnostics);
  makeHypotheses(images, parameters, diagnostics);

  w.candidates.resize(w.hypotheses.size());
  for (std::size_t i = 0; i < w.hypotheses.size(); ++i) {
    w.candidates[i].hypothesis = w.hypotheses[i];
    w.candidates[i].refined = false;
    w.candidates[i].rejected = nullptr;
  }
  detail::CuboidJudge judge(images, w.labels, w.faces, w.borders, w.sensor, parameters);
  judge.judge(w.candidates);
  selectCuboids(w.candidates, w.chosen);
  for (const int i : w.chosen)
    judge.judgeFully(w.candidates[i]);
  std::sort(w.chosen.begin(), w.chosen.end(), [&](int a, int b) {
    const double sa = w.candidates[a].evidence.score;
    const double sb = w.candidates[b].evidence.score;
    return sa > sb || (sa == sb && a < b);
  });
  const auto most = static_cast<std::size_t>(std::max(0, parameters.max_cuboids));
  for (const int i : w.chosen) {
    CuboidCandidate& c = w.candidates[i];
    if (!c.rejected && most > 0 && cuboids.size() == most)
      c.rejected = "more than the maximum number";
    if (!c.rejected)
      cuboids.push_back(detail::toCuboid(c));
  }
  for (const CuboidCandidate& c : w.candidates)
    if (c.rejected)
      diagnostics.rejected.add(c.rejected);
  diagnostics.counts.add("cuboids", cuboids.size());
  return true;
}

void
FullMode::findFaces(const FrameImages& images,
                    const cv::Mat1b& mask,
                    const FullModeParameters& parameters,
                    Diagnostics& diagnostics)
{
  Workspace& w = *workspace_;
  w.camera = images.intrinsics;
  PlanarFaceParameters face_parameters;
  face_parameters.sensor = parameters.sensor;
  w.finder.find(
      images.inverse_depth, mask, w.camera, face_parameters, w.labels, w.faces);
  diagnostics.counts.add("planar faces", w.faces.size());
  w.sensor = parameters.sensor;
  w.sensor.scale *= w.finder.noiseScale();
  findFaceBorders(
      w.labels, images.inverse_depth, mask, w.camera, w.sensor, w.faces, w.borders);
}

void
FullMode::makeHypotheses(const FrameImages& images,
                         const FullModeParameters& parameters,
                         Diagnostics& diagnostics)
{
  Workspace& w = *workspace_;
  CuboidHypothesisParameters limits;
  limits.sensor = w.sensor;
  limits.min_side = parameters.min_side;
  limits.max_side = parameters.max_side;
  limits.support_plane = parameters.support_plane;
  w.hypotheses.clear();
  cuboidsFromFacePairs(w.faces, w.borders, w.camera, limits, w.hypotheses, diagnostics);
  bracketEnds(images.inverse_depth, w.camera, limits, w.hypotheses);
  if (parameters.single_faces)
    cuboidsFromSingleFaces(w.faces, w.borders, w.camera, limits, w.hypotheses);
  extendToSupport(w.faces, w.borders, limits, w.hypotheses);
  completeFromCatalogue(parameters, w.camera, w.sensor, w.hypotheses);
  diagnostics.counts.add("hypotheses", w.hypotheses.size());
}

std::vector<CuboidVerdict>
FullMode::verdicts(const FrameImages& images) const
{
  return workspace_->verdicts(images, [](const CuboidCandidate&) { return true; });
}

std::vector<CuboidVerdict>
FullMode::verdictsAt(const FrameImages& images, int u, int v) const
{
  const Workspace& w = *workspace_;
  return w.verdicts(images, [&](const CuboidCandidate& c) {
    const detail::CuboidView view(c.hypothesis, w.camera, w.sensor, w.labels.size());
    return view.valid() && view.covers(u, v);
  });
}

const PlanarFace*
FullMode::faceAt(int u, int v) const
{
  const Workspace& w = *workspace_;
  if (u < 0 || v < 0 || u >= w.labels.cols || v >= w.labels.rows || w.labels(v, u) == 0)
    return nullptr;
  return &w.faces[w.labels(v, u) - 1];
}

} // namespace hoist
