#include <hoist/segmentation/cuboid_verification.h>

#include "cuboid_view.h"

#include <algorithm>
#include <cmath>

namespace hoist {
namespace {

double
trust(EndSource end)
{
  switch (end) {
  case EndSource::seen:
    return 1.0;
  case EndSource::support:
  case EndSource::bracketed:
  case EndSource::catalogue:
    return 0.95;
  case EndSource::contact:
    return 0.92;
  case EndSource::unknown: // told so, and less than any other answer
    return 0.9;
  case EndSource::bound:
    break;
  }
  return 0.6;
}

// The product of the shares says which of two boxes is better explained; a logistic
// turns it into the chance of being right.
double
calibrated(double product)
{
  constexpr double middle = 0.78, width = 0.04;
  return 1 / (1 + std::exp((middle - product) / width));
}

// A face seen at a grazing angle is a strip of few pixels, and the error of the pose
// alone hides or shows it: the share of its width that a pixel or two cannot change.
double
certainty(const FaceEvidence& e, int stride, double longest_side)
{
  constexpr double blur = 3; // [px]
  const double pixels = static_cast<double>(stride) * stride *
                        (e.support + e.occluded + e.contradiction + e.missing);
  const double width = pixels / longest_side;
  return width > blur ? 1 - blur / width : 0;
}

} // namespace

double
trustInEnds(const CuboidHypothesis& hypothesis)
{
  double all = 1;
  for (const EndSource end : hypothesis.ends)
    all *= trust(end);
  return all;
}

double
highestScore(double trust)
{
  return calibrated(trust);
}

void
verifyCuboid(const CuboidHypothesis& h,
             const cv::Mat1f& inverse_depth,
             const cv::Mat3b& colors,
             const cv::Mat1s& labels,
             const std::vector<PlanarFace>& faces,
             const Intrinsics& camera,
             const SensorModel& sensor,
             int max_samples,
             CuboidEvidence& evidence)
{
  evidence.clear();
  const detail::CuboidView view(h, camera, sensor, inverse_depth.size());
  if (!view.valid())
    return;
  for (int k = 0; k < view.fronts; ++k)
    evidence.visible[view.front[k]] = true;
  detail::collectFaceEvidence(view, inverse_depth, max_samples, evidence);
  const int edge_samples = std::max(10, std::min(40, max_samples / 60));
  detail::collectOutlineEvidence(
      view, inverse_depth, colors, labels, faces, edge_samples, evidence);

  // Faces: the share of what is not covered that lies where it should, weighted by
  // area.
  const Eigen::Vector3d size = h.size();
  double area = 0, flat = 0;
  int observed = 0;
  for (int k = 0; k < view.fronts; ++k) {
    const FaceEvidence& e = evidence.faces[view.front[k]];
    const double open = e.support + e.contradiction + 2 * e.missing_weight * e.missing;
    const int axis = view.front[k] / 2;
    const double longest = std::max(size[(axis + 1) % 3], size[(axis + 2) % 3]);
    const double weight =
        open * certainty(e, evidence.stride, longest / view.pixel) + 1e-9;
    area += weight;
    flat += weight * e.flat;
    constexpr int min_face_pixels = 30;
    const double pixels =
        static_cast<double>(e.support) * evidence.stride * evidence.stride;
    observed += pixels >= min_face_pixels && e.flat > 0.5 ? 1 : 0;
  }
  if (area <= 0)
    return;

  // Edges: the same for the outline, and none may be wrong as a whole.
  double good = 1, bad = 0, excess = 0;
  for (const EdgeEvidence& e : evidence.edges) {
    good += e.good;
    bad += e.bad;
    constexpr int min_edge_samples = 8;
    if (e.samples >= min_edge_samples)
      excess = std::max(excess, (e.bad - e.good) / static_cast<double>(e.samples));
  }
  evidence.flat = flat / area;
  evidence.outline = good / (good + bad);
  double product = std::pow(evidence.flat, 3) * evidence.outline * (1 - excess);
  evidence.trust = trustInEnds(h);
  product *= evidence.trust;
  if (observed < 2 && h.model != CuboidModel::face)
    product *= 0.5; // one face: the third dimension is a guess
  evidence.score = calibrated(product);
}

} // namespace hoist
