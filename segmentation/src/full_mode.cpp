#include <hoist/segmentation/full_mode.h>

#include <hoist/segmentation/cuboid_hypotheses.h>
#include <hoist/segmentation/cuboid_roundness.h>
#include <hoist/segmentation/cuboid_selection.h>
#include <hoist/segmentation/cuboid_verification.h>
#include <hoist/segmentation/face_borders.h>
#include <hoist/segmentation/planar_faces.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hoist {

struct FullMode::Workspace {
  PlanarFaceFinder finder;
  cv::Mat1s labels;
  std::vector<PlanarFace> faces;
  FaceBorders borders;
  std::vector<CuboidHypothesis> hypotheses;
  std::vector<CuboidCandidate> candidates;
  std::vector<int> order, done, chosen;
};

FullMode::FullMode() : workspace_(std::make_unique<Workspace>()) {}
FullMode::~FullMode() = default;
FullMode::FullMode(FullMode&&) noexcept = default;
FullMode& FullMode::operator=(FullMode&&) noexcept = default;

namespace {

Cuboid
toCuboid(const CuboidCandidate& candidate)
{
  const CuboidHypothesis& h = candidate.hypothesis;
  Cuboid c;
  c.center = h.center();
  c.axes = h.axes;
  c.size = h.size();
  c.model = h.model;
  if (candidate.refined) {
    c.center_sigma = candidate.covariance.center;
    c.size_sigma = candidate.covariance.size;
    c.rotation_sigma = candidate.covariance.rotation;
  }
  c.score = candidate.evidence.score;
  for (int i = 0; i < 3; ++i) {
    const EndSource a = h.ends[2 * i], b = h.ends[2 * i + 1];
    c.dimension_source[i] = DimensionSource::measured;
    const auto open = [](EndSource end) {
      return end == EndSource::bound || end == EndSource::contact;
    };
    if (open(a) || open(b)) {
      c.dimension_source[i] = DimensionSource::partial;
      c.size_sigma[i] = std::numeric_limits<double>::quiet_NaN();
    }
    else if (a == EndSource::support || b == EndSource::support)
      c.dimension_source[i] = DimensionSource::support;
    for (int side = 0; side < 2; ++side) {
      const FaceEvidence& e = candidate.evidence.faces[2 * i + side];
      // Cuboid lists the positive face first
      c.observed_faces[2 * i + 1 - side] =
          candidate.evidence.visible[2 * i + side] &&
          e.support > 0.25 * (e.support + e.contradiction + e.missing);
    }
  }
  c.indices.assign(candidate.evidence.support.begin(),
                   candidate.evidence.support.end());
  canonicalize(c);
  return c;
}

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

bool
FullMode::segment(const FrameImages& images,
                  const cv::Mat1b& mask,
                  const FullModeParameters& parameters,
                  std::vector<Cuboid>& cuboids,
                  Diagnostics& diagnostics)
{
  cuboids.clear();
  if (!images.intrinsics.valid())
    return false;
  Workspace& w = *workspace_;
  PlanarFaceParameters face_parameters;
  face_parameters.sensor = parameters.sensor;
  w.finder.find(images.inverse_depth,
                mask,
                images.intrinsics,
                face_parameters,
                w.labels,
                w.faces);
  diagnostics.counts.add("planar faces", w.faces.size());
  SensorModel sensor = parameters.sensor;
  sensor.scale *= w.finder.noiseScale();
  findFaceBorders(w.labels,
                  images.inverse_depth,
                  mask,
                  images.intrinsics,
                  sensor,
                  w.faces,
                  w.borders);

  CuboidHypothesisParameters hypothesis_parameters;
  hypothesis_parameters.sensor = sensor;
  hypothesis_parameters.min_side = parameters.min_side;
  hypothesis_parameters.max_side = parameters.max_side;
  w.hypotheses.clear();
  cuboidsFromFacePairs(w.faces,
                       w.borders,
                       images.intrinsics,
                       hypothesis_parameters,
                       w.hypotheses,
                       diagnostics);
  bracketEnds(
      images.inverse_depth, images.intrinsics, hypothesis_parameters, w.hypotheses);
  extendToSupport(w.faces, w.borders, hypothesis_parameters, w.hypotheses);
  diagnostics.counts.add("hypotheses", w.hypotheses.size());

  const auto verify = [&](CuboidCandidate& c, int max_samples) {
    verifyCuboid(c.hypothesis,
                 images.inverse_depth,
                 images.bgr,
                 w.labels,
                 w.faces,
                 images.intrinsics,
                 sensor,
                 max_samples,
                 c.evidence);
  };
  // A quick look at all, then the promising ones are refined, the best first; a box
  // that starts where one has been refined would end there too.
  constexpr int quick_samples = 600, samples = 3000;
  w.candidates.resize(w.hypotheses.size());
  w.order.clear();
  for (std::size_t i = 0; i < w.hypotheses.size(); ++i) {
    CuboidCandidate& c = w.candidates[i];
    c.hypothesis = w.hypotheses[i];
    c.refined = false;
    verify(c, quick_samples);
    constexpr double min_flat = 0.5, min_outline = 0.4;
    if (c.evidence.flat < min_flat || c.evidence.outline < min_outline) {
      c.evidence.score = 0;
      diagnostics.rejected.add("the frame contradicts it");
      continue;
    }
    w.order.push_back(static_cast<int>(i));
  }
  std::sort(w.order.begin(), w.order.end(), [&](int a, int b) {
    const CuboidEvidence &ea = w.candidates[a].evidence, &eb = w.candidates[b].evidence;
    const double va = ea.flat * ea.outline * ea.pixels();
    const double vb = eb.flat * eb.outline * eb.pixels();
    return va > vb || (va == vb && a < b);
  });
  w.done.clear();
  for (const int i : w.order) {
    CuboidCandidate& c = w.candidates[i];
    const double z = w.hypotheses[i].center().z();
    const double pixel = z / std::min(images.intrinsics.fx, images.intrinsics.fy);
    const double reach = 3 * (pixel + sensor.sigmaZ(z));
    const auto same = [&](int k) {
      return alike(w.hypotheses[k], w.hypotheses[i], reach);
    };
    if (std::any_of(w.done.begin(), w.done.end(), same)) {
      c.evidence.score = 0;
      diagnostics.rejected.add("the same as another");
      continue;
    }
    // It shares its room with a box that explains more than it ever could.
    const auto beaten = [&](int k) {
      const CuboidCandidate& other = w.candidates[k];
      return other.evidence.value() > c.evidence.pixels() &&
             excludeEachOther(other.hypothesis, c.hypothesis);
    };
    if (std::any_of(w.done.begin(), w.done.end(), beaten)) {
      c.evidence.score = 0;
      diagnostics.rejected.add("another explains more there");
      continue;
    }
    w.done.push_back(i);
    verify(c, samples);
    c.refined = refineCuboid(c.hypothesis,
                             c.evidence,
                             images.inverse_depth,
                             w.labels,
                             w.faces,
                             w.borders,
                             images.intrinsics,
                             sensor,
                             c.covariance);
    if (c.refined)
      verify(c, samples);
    if (c.evidence.score < parameters.min_score) {
      diagnostics.rejected.add("score below the minimum");
      continue;
    }
    if (c.hypothesis.size().minCoeff() < parameters.min_side) {
      c.evidence.score = 0;
      diagnostics.rejected.add("side length outside the limits");
      continue;
    }
    // Chosen on rendered tables at 0.8 to 3 m: no box of 606 exceeds 1.05, and of 178
    // others five are below 1.1.
    constexpr double max_roundness = 1.1;
    if (cuboidRoundness(c.hypothesis, images.inverse_depth, images.intrinsics, sensor) >
        max_roundness) {
      c.evidence.score = 0;
      diagnostics.rejected.add("a cylinder explains it better");
    }
  }
  selectCuboids(w.candidates, parameters.min_score, w.chosen);
  for (const int i : w.chosen) {
    // every supporting pixel, and the score of all pixels instead of a sample
    CuboidCandidate& c = w.candidates[i];
    verify(c, std::numeric_limits<int>::max());
    if (c.evidence.score < parameters.min_score) {
      diagnostics.rejected.add("score below the minimum");
      continue;
    }
    cuboids.push_back(toCuboid(c));
  }
  std::stable_sort(cuboids.begin(),
                   cuboids.end(),
                   [](const Cuboid& a, const Cuboid& b) { return a.score > b.score; });
  const auto most = static_cast<std::size_t>(std::max(0, parameters.max_cuboids));
  if (most > 0 && cuboids.size() > most)
    cuboids.resize(most);
  diagnostics.counts.add("cuboids", cuboids.size());
  return true;
}

} // namespace hoist
