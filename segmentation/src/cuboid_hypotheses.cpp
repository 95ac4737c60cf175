#include <hoist/segmentation/cuboid_hypotheses.h>

#include "face_ends.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace hoist {

using detail::FaceEnd;

namespace {

// Faces that continue face i behind something that covers it, as seen from its pair j.
void
coplanarPartners(const std::vector<PlanarFace>& faces,
                 int i,
                 int j,
                 const SensorModel& sensor,
                 double max_side,
                 std::vector<int>& partners)
{
  const PlanarFace& f = faces[i];
  for (int k = 0; k < static_cast<int>(faces.size()); ++k) {
    const PlanarFace& g = faces[k];
    if (k == i || k == j)
      continue;
    const double tilt =
        0.1 + std::min(0.2, 2 * std::hypot(f.normal_sigma, g.normal_sigma));
    if (f.normal.dot(g.normal) < std::cos(tilt))
      continue;
    if ((f.centroid - g.centroid).norm() > max_side)
      continue;
    const double sigma = sensor.sigmaZ(std::max(f.centroid.z(), g.centroid.z()));
    // the larger one's plane is the better known
    const PlanarFace& large = f.pixels > g.pixels ? f : g;
    const PlanarFace& small = f.pixels > g.pixels ? g : f;
    if (std::abs(large.normal.dot(small.centroid) + large.offset) > 4 * sigma)
      continue;
    // the pair must still be convex
    if (faces[j].normal.dot(g.centroid) + faces[j].offset > 2 * sigma)
      continue;
    partners.push_back(k);
  }
}

bool
near(const cv::Rect& a, const cv::Rect& b)
{
  constexpr int reach = 12; // [px]
  return a.x - reach < b.x + b.width && b.x - reach < a.x + a.width &&
         a.y - reach < b.y + b.height && b.y - reach < a.y + a.height;
}

} // namespace

void
cuboidsFromFacePairs(const std::vector<PlanarFace>& faces,
                     const FaceBorders& borders,
                     const Intrinsics& camera,
                     const CuboidHypothesisParameters& parameters,
                     std::vector<CuboidHypothesis>& hypotheses,
                     Diagnostics& diagnostics)
{
  detail::FaceEnds ends(faces, borders, camera);
  std::array<std::vector<int>, 2> partners;
  const auto addHypotheses = [&](const std::array<int, 2>& group_i,
                                 const std::array<int, 2>& group_j,
                                 CuboidHypothesis h) {
    const PlanarFace &fi = faces[group_i[0]], &fj = faces[group_j[0]];
    const Eigen::Vector3d a = h.axes.col(0), b = h.axes.col(1), c = h.axes.col(2);
    const double z = 0.5 * (fi.centroid.z() + fj.centroid.z());
    const double sigma = parameters.sensor.sigmaZ(z);

    // They must meet: each reaches the other's plane, or is covered before it does.
    const FaceEnd i_b = ends.find(group_i, b, sigma),
                  j_a = ends.find(group_j, a, sigma);
    const FaceEnd i_back = ends.find(group_i, -b, sigma);
    const FaceEnd j_back = ends.find(group_j, -a, sigma);
    const auto meets = [&](const FaceEnd& end, const FaceEnd& opposite, double edge) {
      const double gap = edge - end.value;
      const double gate = 4 * end.pixel + 3 * sigma;
      const double extent = end.value + opposite.value;
      return end.seen ? std::abs(gap) < gate : gap > -2 * gate && gap < gate + extent;
    };
    if (!meets(i_b, i_back, h.upper[1]) || !meets(j_a, j_back, h.upper[0])) {
      diagnostics.rejected.add("faces do not meet");
      return;
    }
    h.lower[1] = -i_back.value;
    h.lower[0] = -j_back.value;
    const FaceEnd i_up = ends.find(group_i, c, sigma),
                  j_up = ends.find(group_j, c, sigma);
    const FaceEnd i_down = ends.find(group_i, -c, sigma),
                  j_down = ends.find(group_j, -c, sigma);
    // they share a part of the edge
    const double overlap =
        std::min(i_up.value, j_up.value) - std::max(-i_down.value, -j_down.value);
    const double shorter =
        std::min(i_up.value + i_down.value, j_up.value + j_down.value);
    if (overlap < 0.25 * shorter || shorter <= 0) {
      diagnostics.rejected.add("faces do not meet");
      return;
    }
    const auto source = [](bool seen, int contact) {
      if (!seen)
        return EndSource::bound;
      return contact < 0 ? EndSource::seen : EndSource::contact;
    };
    h.ends = {source(j_back.seen, j_back.contact),
              EndSource::seen,
              source(i_back.seen, i_back.contact),
              EndSource::seen,
              EndSource::bound,
              EndSource::bound};
    h.contacts = {j_back.contact, -1, i_back.contact, -1, -1, -1};

    // Ends along the shared edge: both faces have their say.
    struct Choice {
      double value;
      bool seen;
      int contact;
    };
    const auto choices = [&](const FaceEnd& p, const FaceEnd& q, Choice out[2]) {
      const double window = 2 * std::max(p.pixel, q.pixel) + sigma;
      if (p.seen && q.seen) {
        if (std::abs(p.value - q.value) < window) {
          const double wp = p.votes / (p.pixel * p.pixel);
          const double wq = q.votes / (q.pixel * q.pixel);
          // it touches something there only if neither face ends freely
          const int contact = p.contact < 0 || q.contact < 0 ? -1 : p.contact;
          out[0] = {(p.value * wp + q.value * wq) / (wp + wq), true, contact};
          return 1;
        }
        const FaceEnd &outer = p.value > q.value ? p : q,
                      &inner = p.value > q.value ? q : p;
        out[0] = {outer.value, true, outer.contact};
        out[1] = {inner.value, true, inner.contact};
        return 2;
      }
      if (!p.seen && !q.seen) {
        out[0] = {std::max(p.value, q.value), false, -1};
        return 1;
      }
      const FaceEnd& s = p.seen ? p : q;
      const FaceEnd& hidden = p.seen ? q : p;
      out[0] = {s.value, true, s.contact};
      if (hidden.value > s.value + window) {
        out[1] = {hidden.value, false, -1};
        return 2;
      }
      return 1;
    };
    Choice up[2], down[2];
    const int ups = choices(i_up, j_up, up), downs = choices(i_down, j_down, down);
    for (int x = 0; x < ups; ++x)
      for (int y = 0; y < downs; ++y) {
        h.upper[2] = up[x].value;
        h.lower[2] = -down[y].value;
        h.ends[5] = source(up[x].seen, up[x].contact);
        h.ends[4] = source(down[y].seen, down[y].contact);
        h.contacts[5] = up[x].contact;
        h.contacts[4] = down[y].contact;
        const Eigen::Vector3d size = h.size();
        if (size.minCoeff() < parameters.min_side ||
            size.maxCoeff() > parameters.max_side) {
          diagnostics.rejected.add("side length outside the limits");
          continue;
        }
        hypotheses.push_back(h);
      }
  };
  const auto n = static_cast<int>(faces.size());
  for (int i = 0; i < n; ++i)
    for (int j = i + 1; j < n; ++j) {
      const PlanarFace &fi = faces[i], &fj = faces[j];
      if (!near(fi.box, fj.box))
        continue;
      const double tilt = std::hypot(fi.normal_sigma, fj.normal_sigma);
      const double tolerance = parameters.angle_tolerance + std::min(0.15, 2 * tilt);
      const double cosine = fi.normal.dot(fj.normal);
      if (std::abs(cosine) > tolerance)
        continue;
      // convex: each lies behind the other
      if (fi.normal.dot(fj.centroid) + fi.offset > 0 ||
          fj.normal.dot(fi.centroid) + fj.offset > 0)
        continue;
      diagnostics.counts.add("perpendicular face pairs");

      // Right angle: the better known normal moves less.
      const double vi = fi.normal_sigma * fi.normal_sigma + 1e-8;
      const double vj = fj.normal_sigma * fj.normal_sigma + 1e-8;
      CuboidHypothesis h;
      const Eigen::Vector3d a =
          (fi.normal - fj.normal * cosine * vi / (vi + vj)).normalized();
      Eigen::Vector3d b = fj.normal - a * a.dot(fj.normal);
      b.normalize();
      h.axes.col(0) = a;
      h.axes.col(1) = b;
      h.axes.col(2) = a.cross(b);
      h.faces = {i, j};
      h.upper[0] = a.dot(fi.centroid);
      h.upper[1] = b.dot(fj.centroid);

      partners[0].assign(1, -1);
      partners[1].assign(1, -1);
      coplanarPartners(
          faces, i, j, parameters.sensor, parameters.max_side, partners[0]);
      coplanarPartners(
          faces, j, i, parameters.sensor, parameters.max_side, partners[1]);
      ends.forget();
      const CuboidHypothesis base = h;
      for (const int pi : partners[0])
        for (const int pj : partners[1]) {
          h = base;
          addHypotheses({i, pi}, {j, pj}, h);
        }
    }
}

} // namespace hoist
