#include <hoist/segmentation/cuboid_hypotheses.h>

#include "cuboid_view.h"

#include <algorithm>
#include <cmath>

namespace hoist {
namespace {

// How far a covered end can lie beyond where it was put, before a visible face that
// reached on would cover what the sensor saw behind it. Negative: farther than limit.
double
slack(const detail::CuboidView& view, const cv::Mat1f& image, int end, double limit)
{
  const CuboidHypothesis& h = view.box;
  const int axis = end / 2;
  const double side = CuboidHypothesis::side(end);
  const double step = 2 * view.pixel;
  const auto steps = static_cast<int>(std::ceil(limit / step));
  constexpr int samples = 12;       // across a face
  constexpr double min_share = 0.3; // of them must see through it
  for (int k = 1; k <= steps; ++k)
    for (int i = 0; i < view.fronts; ++i) {
      const int face = view.front[i];
      constexpr double min_cosine = 0.25; // a face at a grazing angle tells nothing
      if (face / 2 == axis ||
          std::abs(h.axes.col(face / 2).dot(h.center().normalized())) < min_cosine)
        continue;
      const int across = 3 - axis - face / 2;
      Eigen::Vector3d local = (h.lower + h.upper) / 2;
      local[face / 2] = h.end(face);
      local[axis] = h.end(end) + side * k * step;
      int through = 0;
      for (int s = 0; s < samples; ++s) {
        local[across] = h.lower[across] + h.size()[across] * (s + 0.5) / samples;
        const Eigen::Vector3d x = h.axes * local;
        if (x.z() < detail::min_depth)
          continue;
        const Eigen::Vector2d q = view.camera.project(x);
        const auto u = static_cast<int>(std::lround(q.x()));
        const auto v = static_cast<int>(std::lround(q.y()));
        if (u < 0 || v < 0 || u >= image.cols || v >= image.rows)
          continue;
        const float w = image(v, u);
        constexpr double gate = 4; // [sigma]
        through +=
            w > 0 && 1 / w > x.z() + gate * view.sensor.sigmaZ(x.z()) + view.pixel;
      }
      if (through >= min_share * samples)
        return k * step + view.pixel; // it was looked at between the pixels
    }
  return -1;
}

} // namespace

void
bracketEnds(const cv::Mat1f& inverse_depth,
            const Intrinsics& camera,
            const CuboidHypothesisParameters& parameters,
            std::vector<CuboidHypothesis>& hypotheses)
{
  constexpr double max_share = 0.15; // of the side
  const std::size_t n = hypotheses.size();
  for (std::size_t i = 0; i < n; ++i)
    for (int f = 0; f < 6; ++f) {
      if (hypotheses[i].ends[f] != EndSource::bound)
        continue;
      CuboidHypothesis h = hypotheses[i];
      const detail::CuboidView view(h, camera, parameters.sensor, inverse_depth.size());
      if (!view.valid())
        continue;
      const double room = slack(view, inverse_depth, f, max_share * h.size()[f / 2]);
      if (room < 0)
        continue;
      h.end(f) += CuboidHypothesis::side(f) * room / 2;
      h.ends[f] = EndSource::bracketed;
      h.room[f] = room;
      hypotheses.push_back(h);
    }
}

} // namespace hoist
