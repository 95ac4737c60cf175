#include <hoist/segmentation/cuboid_hypotheses.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hoist {
namespace {

// Where a face ends along a direction.
struct End {
  double value = 0;  // coordinate along the direction [m]
  bool seen = false; // false: the face is covered there, value is only a bound
  int votes = 0;
  double pixel = 0; // what a pixel is worth along the direction [m]
};

class Ends {
public:
  Ends(const std::vector<PlanarFace>& faces,
       const FaceBorders& borders,
       const Intrinsics& camera)
  : faces_(faces), borders_(borders), camera_(camera)
  {
  }

  // The end of a face along unit vector d. Sigma: noise of the sensor there [m].
  End
  find(int face, const Eigen::Vector3d& d, double sigma)
  {
    const double pixel = footprint(faces_[face], d, camera_);
    const double window = 2 * pixel + sigma;
    votes_.clear();
    double farthest = -std::numeric_limits<double>::max();
    const Eigen::Vector3f direction = d.cast<float>();
    const int first = borders_.first[face], last = borders_.first[face + 1];
    for (int i = first; i < last; ++i) {
      const BorderElement& e = borders_.elements[i];
      const float t = direction.dot(e.point);
      farthest = std::max(farthest, static_cast<double>(t));
      if ((e.kind == BorderKind::crease || e.kind == BorderKind::jump ||
           e.kind == BorderKind::open) &&
          direction.dot(e.outward) > 0.3f)
        votes_.push_back(t);
    }
    End end;
    end.pixel = pixel;
    end.value = farthest;
    if (votes_.empty())
      return end;
    std::sort(votes_.begin(), votes_.end());
    // the highest pile, then the outermost one that comes near it
    int highest = 0;
    const auto pile = [&](std::size_t hi, std::size_t& lo) {
      while (votes_[hi] - votes_[lo] > window)
        ++lo;
      return static_cast<int>(hi - lo + 1);
    };
    std::size_t lo = 0;
    for (std::size_t hi = 0; hi < votes_.size(); ++hi)
      highest = std::max(highest, pile(hi, lo));
    const int enough = std::max(4, static_cast<int>(0.4 * highest));
    lo = 0;
    for (std::size_t hi = 0; hi < votes_.size(); ++hi) {
      const int count = pile(hi, lo);
      if (count >= enough) {
        end.value = votes_[lo + (hi - lo) / 2];
        end.votes = count;
        end.seen = true;
      }
    }
    // Much of the outline beyond the pile and covered there: the pile is not the end.
    if (end.seen) {
      int beyond = 0;
      for (int i = first; i < last; ++i)
        beyond += direction.dot(borders_.elements[i].point) > end.value + window;
      if (beyond > 0.15 * (last - first) && farthest > end.value + 3 * window) {
        end.seen = false;
        end.value = farthest;
      }
    }
    return end;
  }

  // The outermost end of several coplanar faces.
  End
  find(const std::array<int, 2>& group, const Eigen::Vector3d& d, double sigma)
  {
    const End a = find(group[0], d, sigma);
    if (group[1] < 0)
      return a;
    const End b = find(group[1], d, sigma);
    if (std::abs(a.value - b.value) < 2 * std::max(a.pixel, b.pixel) + sigma &&
        a.seen != b.seen)
      return a.seen ? a : b;
    return a.value > b.value ? a : b;
  }

private:
  const std::vector<PlanarFace>& faces_;
  const FaceBorders& borders_;
  const Intrinsics& camera_;
  std::vector<float> votes_;
};

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
  Ends ends(faces, borders, camera);
  std::array<std::vector<int>, 2> partners;
  const auto addHypotheses = [&](const std::array<int, 2>& group_i,
                                 const std::array<int, 2>& group_j,
                                 CuboidHypothesis h) {
    const PlanarFace &fi = faces[group_i[0]], &fj = faces[group_j[0]];
    const Eigen::Vector3d a = h.axes.col(0), b = h.axes.col(1), c = h.axes.col(2);
    const double z = 0.5 * (fi.centroid.z() + fj.centroid.z());
    const double sigma = parameters.sensor.sigmaZ(z);

    // They must meet: each reaches the other's plane, or is covered before it does.
    const End i_b = ends.find(group_i, b, sigma), j_a = ends.find(group_j, a, sigma);
    const End i_back = ends.find(group_i, -b, sigma);
    const End j_back = ends.find(group_j, -a, sigma);
    const auto meets = [&](const End& end, const End& opposite, double edge) {
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
    const End i_up = ends.find(group_i, c, sigma), j_up = ends.find(group_j, c, sigma);
    const End i_down = ends.find(group_i, -c, sigma),
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
    const auto source = [](bool seen) {
      return seen ? EndSource::seen : EndSource::bound;
    };
    h.ends = {source(j_back.seen),
              EndSource::seen,
              source(i_back.seen),
              EndSource::seen,
              EndSource::bound,
              EndSource::bound};

    // Ends along the shared edge: both faces have their say.
    struct Choice {
      double value;
      bool seen;
    };
    const auto choices = [&](const End& p, const End& q, Choice out[2]) {
      const double window = 2 * std::max(p.pixel, q.pixel) + sigma;
      if (p.seen && q.seen) {
        if (std::abs(p.value - q.value) < window) {
          const double wp = p.votes / (p.pixel * p.pixel);
          const double wq = q.votes / (q.pixel * q.pixel);
          out[0] = {(p.value * wp + q.value * wq) / (wp + wq), true};
          return 1;
        }
        out[0] = {std::max(p.value, q.value), true};
        out[1] = {std::min(p.value, q.value), true};
        return 2;
      }
      if (!p.seen && !q.seen) {
        out[0] = {std::max(p.value, q.value), false};
        return 1;
      }
      const End& s = p.seen ? p : q;
      const End& hidden = p.seen ? q : p;
      out[0] = {s.value, true};
      if (hidden.value > s.value + window) {
        out[1] = {hidden.value, false};
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
        h.ends[5] = source(up[x].seen);
        h.ends[4] = source(down[y].seen);
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
      const CuboidHypothesis base = h;
      for (const int pi : partners[0])
        for (const int pj : partners[1]) {
          h = base;
          addHypotheses({i, pi}, {j, pj}, h);
        }
    }
}

void
extendToSupport(const std::vector<PlanarFace>& faces,
                const CuboidHypothesisParameters& parameters,
                std::vector<CuboidHypothesis>& hypotheses)
{
  const std::size_t n = hypotheses.size();
  for (std::size_t i = 0; i < n; ++i)
    for (int f = 0; f < 6; ++f) {
      const CuboidHypothesis h = hypotheses[i];
      if (h.ends[f] != EndSource::bound)
        continue;
      const int axis = f / 2;
      const double side = f % 2 == 0 ? -1.0 : 1.0;
      const Eigen::Vector3d outward = side * h.axes.col(axis);
      // the middle of the end
      Eigen::Vector3d local = (h.lower + h.upper) / 2;
      local[axis] = f % 2 == 0 ? h.lower[axis] : h.upper[axis];
      const Eigen::Vector3d end = h.axes * local;
      const double reach = h.size().norm();
      double nearest = reach;
      for (const PlanarFace& g : faces) {
        constexpr double max_cosine = -0.98; // looks back at the box
        constexpr double min_area_share = 4; // a support is larger than a fragment
        if (outward.dot(g.normal) > max_cosine)
          continue;
        const double distance = -(g.normal.dot(end) + g.offset) / g.normal.dot(outward);
        const double sigma = parameters.sensor.sigmaZ(end.z());
        const Eigen::Vector3d foot = end + distance * outward;
        const Eigen::Vector3d away = g.centroid - foot;
        const double extent = std::sqrt(static_cast<double>(g.pixels)) *
                              g.centroid.z() / 500; // rough radius [m]
        if (distance < 2 * sigma || distance >= nearest ||
            away.norm() > min_area_share * extent)
          continue;
        nearest = distance;
      }
      if (nearest >= reach)
        continue;
      CuboidHypothesis longer = h;
      if (f % 2 == 0)
        longer.lower[axis] -= nearest;
      else
        longer.upper[axis] += nearest;
      longer.ends[f] = EndSource::support;
      if (longer.size().maxCoeff() <= parameters.max_side)
        hypotheses.push_back(longer);
    }
}

} // namespace hoist
