#include <hoist/segmentation/full_mode.h>

#include <hoist/segmentation/cuboid_hypotheses.h>
#include <hoist/segmentation/cuboid_selection.h>
#include <hoist/segmentation/cuboid_verification.h>
#include <hoist/segmentation/face_borders.h>
#include <hoist/segmentation/planar_faces.h>

#include <cmath>

namespace hoist {

struct FullMode::Workspace {
  PlanarFaceFinder finder;
  cv::Mat1s labels;
  std::vector<PlanarFace> faces;
  FaceBorders borders;
  std::vector<CuboidHypothesis> hypotheses;
  std::vector<CuboidCandidate> candidates;
  std::vector<int> chosen;
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
    if (a == EndSource::bound || b == EndSource::bound)
      c.dimension_source[i] = DimensionSource::partial;
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
  extendToSupport(w.faces, hypothesis_parameters, w.hypotheses);
  diagnostics.counts.add("hypotheses", w.hypotheses.size());

  constexpr int max_samples = 4000;
  w.candidates.resize(w.hypotheses.size());
  for (std::size_t i = 0; i < w.hypotheses.size(); ++i) {
    CuboidCandidate& c = w.candidates[i];
    c.hypothesis = w.hypotheses[i];
    verifyCuboid(c.hypothesis,
                 images.inverse_depth,
                 w.labels,
                 w.faces,
                 images.intrinsics,
                 sensor,
                 max_samples,
                 c.evidence);
    c.refined = false;
    constexpr double min_start = 1e-4; // what the first look must give
    if (c.evidence.score > min_start) {
      CuboidHypothesis better = c.hypothesis;
      c.refined = refineCuboid(better,
                               c.evidence,
                               images.inverse_depth,
                               w.labels,
                               w.faces,
                               w.borders,
                               images.intrinsics,
                               sensor,
                               c.covariance);
      if (c.refined) {
        c.hypothesis = better;
        verifyCuboid(c.hypothesis,
                     images.inverse_depth,
                     w.labels,
                     w.faces,
                     images.intrinsics,
                     sensor,
                     max_samples,
                     c.evidence);
      }
    }
    if (c.evidence.score < parameters.min_score)
      diagnostics.rejected.add("score below the minimum");
  }
  selectCuboids(w.candidates,
                parameters.min_score,
                static_cast<int>(images.inverse_depth.total()),
                w.chosen);
  for (const int i : w.chosen) {
    if (parameters.max_cuboids > 0 &&
        static_cast<int>(cuboids.size()) >= parameters.max_cuboids)
      break;
    cuboids.push_back(toCuboid(w.candidates[i]));
  }
  diagnostics.counts.add("cuboids", cuboids.size());
  return true;
}

} // namespace hoist
