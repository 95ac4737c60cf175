#include <hoist/segmentation/cuboid_verification.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hoist {
namespace {

// A side plane of the box as a linear function of the pixel: inverse depth a u + b v +
// c.
struct SidePlane {
  double a = 0, b = 0, c = 0;
  double slope = 0; // change per pixel [1/(m px)]

  double
  at(double u, double v) const
  {
    return a * u + b * v + c;
  }
};

// The plane n . x = d in inverse depth.
SidePlane
toPixels(const Eigen::Vector3d& n, double d, const Intrinsics& k)
{
  SidePlane p;
  p.a = n.x() / (k.fx * d);
  p.b = n.y() / (k.fy * d);
  p.c = (n.z() - n.x() * k.cx / k.fx - n.y() * k.cy / k.fy) / d;
  p.slope = std::hypot(p.a, p.b);
  return p;
}

} // namespace

void
verifyCuboid(const CuboidHypothesis& h,
             const cv::Mat1f& image,
             const Intrinsics& camera,
             const SensorModel& sensor,
             int max_samples,
             CuboidEvidence& evidence)
{
  evidence.faces = {};
  evidence.visible = {};
  evidence.edge_good = evidence.edge_bad = 0;
  evidence.score = 0;
  evidence.support.clear();

  // Corners, bounding rectangle.
  Eigen::Matrix<double, 3, 8> corners;
  double u0 = 1e9, u1 = -1e9, v0 = 1e9, v1 = -1e9, nearest = 1e9;
  for (int k = 0; k < 8; ++k) {
    Eigen::Vector3d p;
    for (int i = 0; i < 3; ++i)
      p[i] = (k >> i & 1) != 0 ? h.upper[i] : h.lower[i];
    corners.col(k) = h.axes * p;
    nearest = std::min(nearest, corners(2, k));
  }
  constexpr double min_depth = 0.05; // [m]
  if (nearest < min_depth)
    return;
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector2d q = camera.project(corners.col(k));
    u0 = std::min(u0, q.x());
    u1 = std::max(u1, q.x());
    v0 = std::min(v0, q.y());
    v1 = std::max(v1, q.y());
  }
  const double z = h.center().z();
  const double pixel = z / std::min(camera.fx, camera.fy);

  // Entry and exit planes. A face is visible if the camera lies outside of it.
  std::array<SidePlane, 6> planes;
  std::array<int, 3> front{};
  std::array<int, 3> back{};
  int fronts = 0, backs = 0;
  const double rim = 1.5 * pixel; // depth is not trusted that near to the outline
  for (int f = 0; f < 6; ++f) {
    const int axis = f / 2;
    const double side = f % 2 == 0 ? -1.0 : 1.0;
    const double bound = f % 2 == 0 ? h.lower[axis] : h.upper[axis];
    evidence.visible[f] = side * bound < 0; // the origin is beyond the plane
    if (evidence.visible[f]) {
      if (fronts == 3 || std::abs(bound) < 1e-4)
        return;
      planes[f] = toPixels(h.axes.col(axis), bound, camera);
      front[fronts++] = f;
    }
    else if (backs < 3 + 3) {
      // moved inwards by the rim, which pulls the outline in
      double moved = bound - side * std::min(rim, 0.25 * h.size()[axis]);
      if (std::abs(moved) < 1e-4)
        moved = 1e-4 * side;
      planes[f] = toPixels(h.axes.col(axis), moved, camera);
      if (backs < 3)
        back[backs] = f;
      ++backs;
    }
  }
  if (fronts == 0)
    return;
  // fewer than three visible faces: more than three hidden ones
  std::array<int, 6> hidden{};
  int n_hidden = 0;
  for (int f = 0; f < 6; ++f)
    if (!evidence.visible[f])
      hidden[n_hidden++] = f;

  const int left = std::max(0, static_cast<int>(std::ceil(u0)));
  const int right = std::min(image.cols - 1, static_cast<int>(std::floor(u1)));
  const int top = std::max(0, static_cast<int>(std::ceil(v0)));
  const int bottom = std::min(image.rows - 1, static_cast<int>(std::floor(v1)));
  if (left > right || top > bottom)
    return;
  const double area = static_cast<double>(right - left + 1) * (bottom - top + 1);
  const int stride =
      std::max(1, static_cast<int>(std::lround(std::sqrt(area / max_samples))));
  evidence.stride = stride;

  for (int v = top; v <= bottom; v += stride) {
    const float* row = image[v];
    for (int u = left; u <= right; u += stride) {
      // Inverse depth falls along a ray: the box is entered at the smallest of the
      // visible planes and left at the largest of the hidden ones.
      double enter = std::numeric_limits<double>::max();
      int face = 0;
      for (int k = 0; k < fronts; ++k) {
        const double w = planes[front[k]].at(u, v);
        if (w < enter) {
          enter = w;
          face = front[k];
        }
      }
      if (enter <= 0)
        continue;
      bool inside = true;
      for (int k = 0; k < n_hidden && inside; ++k)
        inside = planes[hidden[k]].at(u, v) < enter;
      if (!inside)
        continue;
      FaceEvidence& e = evidence.faces[face];
      const float w = row[u];
      if (!(w > 0)) {
        ++e.missing;
        continue;
      }
      const double noise = sensor.sigmaZ(1 / enter) * enter * enter;
      // a pixel of lateral error shifts an oblique face in depth
      const double lateral = planes[face].slope;
      const double sigma = std::sqrt(noise * noise + lateral * lateral);
      const double r = (w - enter) / sigma;
      constexpr double gate = 3.5;
      if (r > gate)
        ++e.occluded;
      else if (r < -gate)
        ++e.contradiction;
      else {
        ++e.support;
        evidence.support.push_back(v * image.cols + u);
      }
    }
  }

  // Outline: just beyond every edge between a visible and a hidden face, the visible
  // face must not go on.
  for (int k = 0; k < fronts; ++k) {
    const int f = front[k];
    const int axis = f / 2;
    for (int m = 0; m < n_hidden; ++m) {
      const int g = hidden[m];
      const int across = g / 2;
      if (across == axis)
        continue;
      const int along = 3 - axis - across;
      Eigen::Vector3d p;
      p[axis] = f % 2 == 0 ? h.lower[axis] : h.upper[axis];
      const double side = g % 2 == 0 ? -1.0 : 1.0;
      // far enough that the sensor's fringe is passed
      const double beyond = 3.5 * pixel + sensor.sigmaZ(z);
      p[across] = (g % 2 == 0 ? h.lower[across] : h.upper[across]) + side * beyond;
      const double length = h.upper[along] - h.lower[along];
      const int samples =
          std::max(4, std::min(40, static_cast<int>(length / (2 * pixel))));
      for (int s = 0; s < samples; ++s) {
        p[along] = h.lower[along] + length * (s + 0.5) / samples;
        const Eigen::Vector3d x = h.axes * p;
        if (x.z() < min_depth)
          continue;
        const Eigen::Vector2d q = camera.project(x);
        const int u = static_cast<int>(std::lround(q.x()));
        const int v = static_cast<int>(std::lround(q.y()));
        if (u < 0 || v < 0 || u >= image.cols || v >= image.rows)
          continue;
        const float w = image(v, u);
        if (!(w > 0)) {
          ++evidence.edge_good;
          continue;
        }
        const double expected = planes[f].at(u, v);
        const double noise = sensor.sigmaZ(x.z()) * expected * expected;
        const double r = (w - expected) / noise;
        constexpr double gate = 2.5;
        if (r > gate)
          continue; // covered or a surface that rises: says nothing
        if (r < -gate)
          ++evidence.edge_good;
        else
          ++evidence.edge_bad;
      }
    }
  }

  // The score: what was seen as it should be among what could be seen, face by face
  // weighted by its size, times the share of the outline where the surface ends.
  double good = 0, bad = 0;
  int observed = 0;
  for (int k = 0; k < fronts; ++k) {
    const FaceEvidence& e = evidence.faces[front[k]];
    good += e.support;
    bad += e.contradiction + 0.5 * e.missing;
    const int open = e.support + e.contradiction + e.missing;
    observed += e.support * stride * stride >= 30 && e.support > 0.4 * open ? 1 : 0;
    // a face that is contradicted as a whole is no face
    if (e.contradiction > e.support && e.contradiction > 0.1 * (good + bad))
      bad += e.contradiction;
  }
  if (good <= 0)
    return;
  const double faces = good / (good + bad);
  const double edges =
      (evidence.edge_good + 2.0) / (evidence.edge_good + evidence.edge_bad + 2.0);
  evidence.score = faces * std::sqrt(edges);
  if (observed < 2)
    evidence.score *= 0.5; // one face: the third dimension is a guess
}

} // namespace hoist
