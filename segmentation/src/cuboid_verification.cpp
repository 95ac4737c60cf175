#include <hoist/segmentation/cuboid_verification.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hoist {
namespace {

// The product of the shares says which of two boxes is better explained; a logistic
// turns it into the chance of being right.
double
calibrated(double product)
{
  constexpr double middle = 0.78, width = 0.04;
  return 1 / (1 + std::exp((middle - product) / width));
}

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

// A face is judged patch by patch: single pixels are noisy, the mean of a patch is not.
constexpr int patches = 6; // along either side

struct Patch {
  int support = 0, occluded = 0, contradiction = 0, missing = 0;
  double sum = 0; // of the supporting residuals, along the normal [m]
};

using PatchGrid = std::array<Patch, static_cast<std::size_t>(patches) * patches>;

// Share of the uncovered patches whose mean lies on the face.
double
flatShare(const PatchGrid& grid, double noise, double tolerance)
{
  double good = 0, bad = 0;
  for (const Patch& p : grid) {
    const int open = p.support + p.contradiction + p.missing;
    if (open < 2 || p.occluded > open)
      continue;
    // nothing measured is weak evidence against, seen through is strong
    const double weight = p.support + p.contradiction + 0.5 * p.missing;
    const double limit = tolerance + 2 * noise / std::sqrt(std::max(1, p.support));
    if (p.support > p.contradiction + p.missing && std::abs(p.sum / p.support) < limit)
      good += weight;
    else
      bad += weight;
  }
  return good + bad > 0 ? good / (good + bad) : 0;
}

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
             const cv::Mat1s& labels,
             const std::vector<PlanarFace>& faces,
             const Intrinsics& camera,
             const SensorModel& sensor,
             int max_samples,
             CuboidEvidence& evidence)
{
  evidence.faces = {};
  evidence.visible = {};
  evidence.edges.clear();
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

  std::array<PatchGrid, 3> grids{}; // of the visible faces, in the order of front
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
          face = k;
        }
      }
      if (enter <= 0)
        continue;
      bool inside = true;
      for (int k = 0; k < n_hidden && inside; ++k)
        inside = planes[hidden[k]].at(u, v) < enter;
      if (!inside)
        continue;
      const int axis = front[face] / 2, p = (axis + 1) % 3, q = (axis + 2) % 3;
      const double bound = front[face] % 2 == 0 ? h.lower[axis] : h.upper[axis];
      const Eigen::Vector3d ray = h.axes.transpose() * camera.ray(u, v);
      const auto cell = [&](int i) {
        const double t = (ray[i] / enter - h.lower[i]) / (h.upper[i] - h.lower[i]);
        return std::min(patches - 1, std::max(0, static_cast<int>(t * patches)));
      };
      Patch& patch = grids[face][cell(p) * patches + cell(q)];
      FaceEvidence& e = evidence.faces[front[face]];
      const float w = row[u];
      if (!(w > 0)) {
        ++e.missing;
        ++patch.missing;
        continue;
      }
      const double noise = sensor.sigmaZ(1 / enter) * enter * enter;
      // a pixel of lateral error shifts an oblique face in depth
      const double lateral = planes[front[face]].slope;
      const double sigma = std::sqrt(noise * noise + lateral * lateral);
      const double r = (w - enter) / sigma;
      constexpr double gate = 3.5;
      if (r > gate) {
        ++e.occluded;
        ++patch.occluded;
      }
      else if (r < -gate) {
        ++e.contradiction;
        ++patch.contradiction;
      }
      else {
        ++e.support;
        ++patch.support;
        patch.sum += ray[axis] / w - bound;
        evidence.support.push_back(v * image.cols + u);
      }
    }
  }
  const double noise_at_center = sensor.sigmaZ(z);
  for (int k = 0; k < fronts; ++k) {
    const int axis = front[k] / 2;
    const Eigen::Vector3d size = h.size();
    const double shorter = std::min(size[(axis + 1) % 3], size[(axis + 2) % 3]);
    // real cartons bulge: a few per cent of the side
    const double tolerance = 0.03 * shorter + 0.5 * noise_at_center;
    evidence.faces[front[k]].flat = flatShare(grids[k], noise_at_center, tolerance);
  }

  // Outline: just beyond every edge between a visible and a hidden face, the visible
  // face must not go on.
  for (int k = 0; k < fronts; ++k) {
    const int f = front[k];
    const int axis = f / 2;
    // A face seen at a grazing angle is a sliver; a degree of tilt hides or shows it.
    constexpr double min_cosine = 0.2;
    if (std::abs(h.axes.col(axis).dot(h.center().normalized())) < min_cosine)
      continue;
    const double toward_camera = f % 2 == 0 ? -1.0 : 1.0;
    Eigen::Vector3d local_center = (h.lower + h.upper) / 2;
    local_center[axis] = f % 2 == 0 ? h.lower[axis] : h.upper[axis];
    const Eigen::Vector3d face_center = h.axes * local_center;
    for (int m = 0; m < n_hidden; ++m) {
      const int g = hidden[m];
      const int across = g / 2;
      if (across == axis)
        continue;
      const int along = 3 - axis - across;
      Eigen::Vector3d p;
      p[axis] = f % 2 == 0 ? h.lower[axis] : h.upper[axis];
      const double side = g % 2 == 0 ? -1.0 : 1.0;
      // Far enough that the sensor's fringe is passed, in the image too: an oblique
      // face is foreshortened.
      p[along] = 0.5 * (h.lower[along] + h.upper[along]);
      p[across] = g % 2 == 0 ? h.lower[across] : h.upper[across];
      const Eigen::Vector3d on_edge = h.axes * p;
      const Eigen::Vector3d outside = on_edge + side * pixel * h.axes.col(across);
      if (on_edge.z() < min_depth || outside.z() < min_depth)
        continue;
      const double shift =
          (camera.project(outside) - camera.project(on_edge)).norm(); // [px]
      constexpr double max_stretch = 4;
      if (shift * max_stretch < 1)
        continue; // seen edge on
      const double beyond =
          3.5 * pixel / std::min(1.0, shift) + sensor.sigmaZ(on_edge.z());
      p[across] += side * beyond;
      const double length = h.upper[along] - h.lower[along];
      // What the box stands on rises from its face like the floor from a wall: twice
      // as far out it is clearly above the face's plane.
      const auto risesFartherOut = [&](Eigen::Vector3d at, int axis_out, double sign) {
        at[axis_out] += sign * 1.5 * beyond;
        const Eigen::Vector3d x = h.axes * at;
        if (x.z() < min_depth)
          return false;
        const Eigen::Vector2d q = camera.project(x);
        const int u = static_cast<int>(std::lround(q.x()));
        const int v = static_cast<int>(std::lround(q.y()));
        if (u < 0 || v < 0 || u >= image.cols || v >= image.rows || !(image(v, u) > 0))
          return false;
        const Eigen::Vector3d ray = camera.ray(u, v);
        const double toward = h.axes.col(axis).dot(ray) * toward_camera;
        const double height = toward / image(v, u) - at[axis] * toward_camera;
        return height > 2 * (sensor.sigmaZ(x.z()) * std::abs(toward) + 0.5 * pixel);
      };
      EdgeEvidence edge;
      edge.face = f;
      edge.neighbour = g;
      const int samples =
          std::max(4, std::min(40, static_cast<int>(length / (2 * pixel))));
      edge.samples = samples;
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
          ++edge.good;
          continue;
        }
        // Height of what was measured there over the face's plane. Just below the plane
        // means that the surface goes on or bends away slowly, as a cylinder's does; a
        // box ends in a step.
        const double bound = f % 2 == 0 ? h.lower[axis] : h.upper[axis];
        const Eigen::Vector3d ray = camera.ray(u, v);
        const double cosine = std::abs(h.axes.col(axis).dot(ray));
        const double height = (h.axes.col(axis).dot(ray) / w - bound) * toward_camera;
        const double noise = sensor.sigmaZ(x.z()) * cosine + 0.5 * pixel;
        constexpr double gate = 2.5;
        if (height > gate * noise)
          continue; // covered or a surface that rises: says nothing
        if (height > -gate * noise - beyond) {
          // What the box stands on or leans against meets it concavely: the middle of
          // the face lies in front of that surface.
          const short label = labels(v, u);
          if (label > 0) {
            const PlanarFace& other = faces[label - 1];
            const double turn = other.normal.dot(h.axes.col(axis)) * toward_camera;
            if (turn < 0.94 && other.normal.dot(face_center) + other.offset > 2 * noise)
              continue;
          }
          if (risesFartherOut(p, across, side))
            continue;
        }
        if (height < -gate * noise - beyond)
          ++edge.good;
        else
          ++edge.bad;
      }
      evidence.edges.push_back(edge);
    }
  }

  // The score. Faces: the share of what is not covered that lies where it should,
  // weighted by area. Edges: the same for the outline.
  double area_sum = 0, flat_sum = 0;
  int observed = 0;
  for (int k = 0; k < fronts; ++k) {
    const FaceEvidence& e = evidence.faces[front[k]];
    const double open = e.support + e.contradiction + e.missing;
    area_sum += open;
    flat_sum += open * e.flat;
    observed += e.support * stride * stride >= 30 && e.flat > 0.5 ? 1 : 0;
  }
  if (area_sum <= 0)
    return;
  double good = 1, bad = 0, worst = 1, excess = 0;
  for (const EdgeEvidence& e : evidence.edges) {
    good += e.good;
    bad += e.bad;
    constexpr int min_edge_samples = 8;
    if (e.samples >= min_edge_samples)
      excess = std::max(excess, (e.bad - e.good) / static_cast<double>(e.samples));
    if (e.good + e.bad > 0.25 * e.samples)
      worst = std::min(worst, (e.good + 1.0) / (e.good + e.bad + 1.0));
  }
  evidence.flat = flat_sum / area_sum;
  evidence.outline = good / (good + bad);
  evidence.worst_edge = worst;
  evidence.score =
      evidence.flat * evidence.flat * evidence.flat * evidence.outline * (1 - excess);
  for (const EndSource end : h.ends)
    evidence.score *= end == EndSource::seen      ? 1.0
                      : end == EndSource::support ? 0.95
                                                  : 0.6;
  if (observed < 2)
    evidence.score *= 0.5; // one face: the third dimension is a guess
  evidence.score = calibrated(evidence.score);
}

} // namespace hoist
