#include "to_cuboid.h"

#include <limits>

namespace hoist {
namespace detail {

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
    const auto either = [a, b](EndSource end) { return a == end || b == end; };
    if (either(EndSource::unknown)) {
      c.dimension_source[i] = DimensionSource::unknown;
      c.size_sigma[i] = std::numeric_limits<double>::quiet_NaN();
    }
    else if (either(EndSource::bound) || either(EndSource::contact)) {
      c.dimension_source[i] = DimensionSource::partial;
      c.size_sigma[i] = std::numeric_limits<double>::quiet_NaN();
    }
    else if (either(EndSource::catalogue))
      c.dimension_source[i] = DimensionSource::catalogue;
    else if (either(EndSource::support))
      c.dimension_source[i] = DimensionSource::support;
    else if (either(EndSource::bracketed))
      c.dimension_source[i] = DimensionSource::bracketed;
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

} // namespace detail
} // namespace hoist
