#include "cuboid_view.h"
#include "planar_faces_moments.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hoist {
namespace detail {
namespace {

// A face is judged patch by patch: single pixels are noisy, the mean of a patch is not.
constexpr int patches = 6; // along either side

struct Patch {
  int support = 0, occluded = 0, contradiction = 0, missing = 0;
  double sum = 0; // of the supporting residuals, along the normal [m]
};

using PatchGrid = std::array<Patch, static_cast<std::size_t>(patches) * patches>;

// What the nearer of the two surfaces beside a gap in a row measures, 0 where neither
// is within reach: a depth sensor sees nothing in the shadow that its projector, or its
// second camera, has beside a nearer thing.
float
nearerBeside(const float* row, int u, int width)
{
  const int reach = width / 10;
  const int first = std::max(0, u - reach), last = std::min(width - 1, u + reach);
  int left = u - 1, right = u + 1;
  while (left >= first && !(row[left] > 0))
    --left;
  while (right <= last && !(row[right] > 0))
    ++right;
  return std::max(left >= first ? row[left] : 0.0f, right <= last ? row[right] : 0.0f);
}

// Where a row of the image sees the box: its visible planes lie before its hidden ones
// and before the camera, all of them linear in the pixel.
class Silhouette {
public:
  explicit Silhouette(const CuboidView& view) : left_(view.left), right_(view.right)
  {
    for (int i = 0; i < view.fronts; ++i) {
      const PixelPlane& front = view.planes[view.front[i]];
      add(front);
      for (int k = 0; k < view.n_hidden; ++k) {
        const PixelPlane& hidden = view.planes[view.hidden[k]];
        add({front.a - hidden.a, front.b - hidden.b, front.c - hidden.c});
      }
    }
  }

  cv::Range
  row(int v) const
  {
    double first = left_, last = right_;
    for (int i = 0; i < n_; ++i) {
      const double value = half_planes_[i].b * v + half_planes_[i].c;
      const double zero = -value * inverse_[i];
      if (half_planes_[i].a > 0)
        first = std::max(first, zero);
      else if (half_planes_[i].a < 0)
        last = std::min(last, zero);
      else if (value <= 0)
        return {0, 0};
    }
    if (!(first <= last))
      return {0, 0};
    return {static_cast<int>(std::ceil(first)), static_cast<int>(last) + 1};
  }

private:
  void
  add(const PixelPlane& p)
  {
    half_planes_[n_] = p;
    inverse_[n_++] = p.a != 0 ? 1 / p.a : 0;
  }

  int left_, right_;
  int n_ = 0;
  std::array<PixelPlane, 18> half_planes_; // positive inside
  std::array<double, 18> inverse_{};       // of their a
};

// Share of the uncovered patches whose mean lies on the face.
double
flatShare(const PatchGrid& grid, double missing_weight, double noise, double tolerance)
{
  double good = 0, bad = 0;
  for (const Patch& p : grid) {
    const int open = p.support + p.contradiction + p.missing;
    if (open < 2 || p.occluded > open)
      continue;
    const double weight = p.support + p.contradiction + missing_weight * p.missing;
    const double limit = tolerance + 2 * noise / std::sqrt(std::max(1, p.support));
    if (p.support > p.contradiction + p.missing && std::abs(p.sum / p.support) < limit)
      good += weight;
    else
      bad += weight;
  }
  return good + bad > 0 ? good / (good + bad) : 0;
}

} // namespace

void
collectFaceEvidence(const CuboidView& view,
                    const cv::Mat1f& image,
                    int max_samples,
                    CuboidEvidence& evidence)
{
  const CuboidHypothesis& h = view.box;
  const double area = (view.right - view.left + 1.0) * (view.bottom - view.top + 1.0);
  const int stride =
      std::max(1, static_cast<int>(std::lround(std::sqrt(area / max_samples))));
  evidence.stride = stride;

  std::array<PatchGrid, 3> grids{}; // of the visible faces, in the order of front
  std::array<double, 3> lateral_square{};
  for (int k = 0; k < view.fronts; ++k) {
    // a pixel of lateral error shifts an oblique face in depth
    const PixelPlane& p = view.planes[view.front[k]];
    lateral_square[k] = p.a * p.a + p.b * p.b;
  }
  const Eigen::Vector3d cell = h.size().cwiseInverse() * patches;
  // rays in the box's axes change by a constant from pixel to pixel
  const Eigen::Vector3d ray_step = h.axes.row(0).transpose() / view.camera.fx;
  const InverseDepthNoise sigma(view.sensor);
  const Silhouette silhouette(view);
  for (int v = view.top; v <= view.bottom; v += stride) {
    const cv::Range columns = silhouette.row(v);
    if (columns.empty())
      continue;
    const float* row = image[v];
    const Eigen::Vector3d ray0 = h.axes.transpose() * view.camera.ray(0, v);
    std::array<double, 3> base{}, slope{}; // of the visible planes along the row
    for (int i = 0; i < view.fronts; ++i) {
      const PixelPlane& plane = view.planes[view.front[i]];
      base[i] = plane.b * v + plane.c;
      slope[i] = plane.a;
    }
    const int first = (columns.start - view.left + stride - 1) / stride;
    for (int u = view.left + first * stride; u < columns.end; u += stride) {
      // inverse depth falls along a ray: the box is entered at the smallest
      double enter = slope[0] * u + base[0];
      int k = 0;
      for (int i = 1; i < view.fronts; ++i) {
        const double w = slope[i] * u + base[i];
        k = w < enter ? i : k;
        enter = std::min(enter, w);
      }
      const double z = 1 / enter;
      const int f = view.front[k];
      const int axis = f / 2, p = (axis + 1) % 3, q = (axis + 2) % 3;
      const Eigen::Vector3d ray = ray0 + ray_step * u;
      const auto index = [&](int i) {
        const auto t = static_cast<int>((ray[i] * z - h.lower[i]) * cell[i]);
        return std::min(patches - 1, std::max(0, t));
      };
      Patch& patch = grids[k][index(p) * patches + index(q)];
      FaceEvidence& e = evidence.faces[f];
      const float w = row[u];
      const double noise = sigma(enter);
      constexpr double gate = 3.5;
      const double gate_square = gate * gate * (noise * noise + lateral_square[k]);
      if (!(w > 0)) {
        const double beside = nearerBeside(row, u, image.cols) - enter;
        const bool shadow = beside > 0 && beside * beside > gate_square;
        ++(shadow ? e.occluded : e.missing);
        ++(shadow ? patch.occluded : patch.missing);
        continue;
      }
      const double r = w - enter;
      const bool near = r * r <= gate_square;
      if (near) {
        ++e.support;
        ++patch.support;
        patch.sum += ray[axis] / w - view.box.end(f);
        evidence.support.push_back(v * image.cols + u);
      }
      else if (r > 0) {
        ++e.occluded;
        ++patch.occluded;
      }
      else {
        ++e.contradiction;
        ++patch.contradiction;
      }
    }
  }
  const double noise = view.sensor.sigmaZ(h.center().z());
  const Eigen::Vector3d size = h.size();
  for (int k = 0; k < view.fronts; ++k) {
    const int axis = view.front[k] / 2;
    const double shorter = std::min(size[(axis + 1) % 3], size[(axis + 2) % 3]);
    // real cartons bulge: a few per cent of the side
    const double tolerance = 0.03 * shorter + 0.5 * noise;
    // Nothing measured is weak evidence against, seen through is strong. A face without
    // any depth, in the projector's shadow say, is hardly evidence at all.
    FaceEvidence& e = evidence.faces[view.front[k]];
    e.missing_weight = e.missing > 4 * (e.support + e.contradiction) ? 0.1 : 0.5;
    e.flat = flatShare(grids[k], e.missing_weight, noise, tolerance);
  }
}

} // namespace detail
} // namespace hoist
