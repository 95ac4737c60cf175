#include <hoist/segmentation/cuboid_hypotheses.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace hoist {
namespace {

// The rectangle in its plane that a face fills: what stands on the face stands inside.
struct Extent {
  Eigen::Vector3d axes[2];
  double lower[2], upper[2]; // coordinates along the axes [m]

  Extent(const PlanarFace& face, const BorderElement* first, const BorderElement* last)
  {
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const BorderElement* e = first; e != last; ++e) {
      const Eigen::Vector3d d = e->point.cast<double>() - face.centroid;
      scatter += d * d.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
    for (int k = 0; k < 2; ++k) {
      axes[k] = solver.eigenvectors().col(2 - k);
      lower[k] = upper[k] = axes[k].dot(face.centroid);
      const Eigen::Vector3f axis = axes[k].cast<float>();
      for (const BorderElement* e = first; e != last; ++e) {
        const double t = axis.dot(e->point);
        lower[k] = std::min(lower[k], t);
        upper[k] = std::max(upper[k], t);
      }
    }
  }

  bool
  contains(const Eigen::Vector3d& point, double margin) const
  {
    for (int k = 0; k < 2; ++k) {
      const double t = axes[k].dot(point);
      if (t < lower[k] - margin || t > upper[k] + margin)
        return false;
    }
    return true;
  }
};

// The middle of an end of a box.
Eigen::Vector3d
middleOf(const CuboidHypothesis& h, int f)
{
  Eigen::Vector3d local = (h.lower + h.upper) / 2;
  local[f / 2] = h.end(f);
  return h.axes * local;
}

// How far from a point on a box's end, along the outward normal, a plane lies that is
// parallel to the end; infinity if it is not [m].
double
distanceTo(const Eigen::Vector4d& plane,
           const Eigen::Vector3d& end,
           const Eigen::Vector3d& outward)
{
  const double slope = plane.head<3>().dot(outward);
  constexpr double min_cosine = 0.98;
  if (std::abs(slope) < min_cosine * plane.head<3>().norm())
    return std::numeric_limits<double>::infinity();
  return -(plane.head<3>().dot(end) + plane[3]) / slope;
}

// The foot of a box that reaches through the plane is put onto it.
void
endAtPlane(const Eigen::Vector4d& plane, const SensorModel& sensor, CuboidHypothesis& h)
{
  // the side of the plane where the camera is
  const Eigen::Vector3d up = plane[3] < 0 ? Eigen::Vector3d(-plane.head<3>())
                                          : Eigen::Vector3d(plane.head<3>());
  for (int f = 0; f < 6; ++f) {
    if (up.dot(h.outward(f)) >= 0)
      continue;
    const Eigen::Vector3d end = middleOf(h, f);
    const double distance = distanceTo(plane, end, h.outward(f));
    const double most = h.size()[f / 2]; // a box all below it is left alone
    if (distance < -2 * sensor.sigmaZ(end.z()) && distance > -most) {
      h.end(f) += CuboidHypothesis::side(f) * distance;
      h.ends[f] = EndSource::support;
    }
  }
}

} // namespace

void
extendToSupport(const std::vector<PlanarFace>& faces,
                const FaceBorders& borders,
                const CuboidHypothesisParameters& parameters,
                std::vector<CuboidHypothesis>& hypotheses)
{
  std::vector<std::optional<Extent>> extents(faces.size());
  const auto extentOf = [&](std::size_t g) -> const Extent& {
    if (!extents[g]) {
      const BorderElement* elements = borders.elements.data();
      extents[g].emplace(
          faces[g], elements + borders.first[g], elements + borders.first[g + 1]);
    }
    return *extents[g];
  };
  constexpr double margin_share = 0.25; // its own foot may hide where the surface ends
  // What touches a box at its end carries it if the box is over it; then it ends there.
  for (CuboidHypothesis& h : hypotheses)
    for (int f = 0; f < 6; ++f) {
      if (h.ends[f] != EndSource::contact)
        continue;
      constexpr double max_cosine = -0.7;
      const std::size_t k = h.contacts[f];
      if (h.outward(f).dot(faces[k].normal) < max_cosine &&
          extentOf(k).contains(middleOf(h, f), margin_share * h.size().maxCoeff()))
        h.ends[f] = EndSource::seen;
    }
  if (parameters.support_plane)
    for (CuboidHypothesis& h : hypotheses)
      endAtPlane(*parameters.support_plane, parameters.sensor, h);
  const std::size_t n = hypotheses.size();
  for (std::size_t i = 0; i < n; ++i)
    for (int f = 0; f < 6; ++f) {
      const EndSource known = hypotheses[i].ends[f];
      if (known != EndSource::bound && known != EndSource::contact &&
          known != EndSource::unknown)
        continue;
      const CuboidHypothesis h = hypotheses[i];
      const Eigen::Vector3d outward = h.outward(f), end = middleOf(h, f);
      const double sigma = parameters.sensor.sigmaZ(end.z());
      const double reach = 2 * h.size().norm(); // more hidden than seen is too bold
      const double margin = margin_share * h.size().maxCoeff();
      double nearest = reach;
      for (std::size_t k = 0; k < faces.size(); ++k) {
        const PlanarFace& g = faces[k];
        constexpr double max_cosine = -0.98; // looks back at the box
        if (outward.dot(g.normal) > max_cosine)
          continue;
        const double distance = -(g.normal.dot(end) + g.offset) / g.normal.dot(outward);
        if (distance < 2 * sigma || distance >= nearest)
          continue;
        if (extentOf(k).contains(end + distance * outward, margin))
          nearest = distance;
      }
      if (parameters.support_plane) {
        const double distance = distanceTo(*parameters.support_plane, end, outward);
        if (distance >= 2 * sigma && distance < nearest)
          nearest = distance;
      }
      if (nearest >= reach)
        continue;
      CuboidHypothesis longer = h;
      longer.end(f) += CuboidHypothesis::side(f) * nearest;
      longer.ends[f] = EndSource::support;
      longer.given[f / 2] = 0;
      if (longer.size().maxCoeff() <= parameters.max_side)
        hypotheses.push_back(longer);
    }
}

} // namespace hoist
