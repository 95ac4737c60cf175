#include <hoist/segmentation/cuboid_hypotheses.h>

#include "face_ends.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace hoist {
namespace {

constexpr int min_pixels = 400; // of a face whose outline says which way it lies
constexpr std::size_t max_points = 400;

// Mean distance of points to the nearest side of the rectangle at this angle around
// them, one in fifty at each side left out.
double
distanceToRectangle(const std::vector<Eigen::Vector2d>& points,
                    double angle,
                    std::array<std::vector<double>, 2>& along,
                    std::vector<double>& sorted)
{
  const Eigen::Vector2d axis(std::cos(angle), std::sin(angle));
  double low[2], high[2];
  for (int k = 0; k < 2; ++k) {
    const Eigen::Vector2d d = k == 0 ? axis : Eigen::Vector2d(-axis.y(), axis.x());
    along[k].clear();
    for (const Eigen::Vector2d& p : points)
      along[k].push_back(d.dot(p));
    sorted = along[k];
    const auto cut = static_cast<std::ptrdiff_t>(sorted.size() / 50);
    const auto first = sorted.begin() + cut, last = sorted.end() - 1 - cut;
    std::nth_element(sorted.begin(), first, sorted.end());
    low[k] = *first;
    std::nth_element(sorted.begin(), last, sorted.end());
    high[k] = *last;
  }
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    sum += std::min({std::abs(along[0][i] - low[0]),
                     std::abs(along[0][i] - high[0]),
                     std::abs(along[1][i] - low[1]),
                     std::abs(along[1][i] - high[1])});
  return sum / static_cast<double>(points.size());
}

// The angle of the rectangle that an outline follows, in [0, 90) degrees to a half: the
// rest is left to the refinement.
double
angleOf(const std::vector<Eigen::Vector2d>& points)
{
  std::array<std::vector<double>, 2> along;
  std::vector<double> sorted;
  double best = 0, least = std::numeric_limits<double>::infinity();
  const auto search = [&](double from, double step, int n) {
    for (int i = 0; i < n; ++i) {
      const double angle = from + i * step;
      const double mean = distanceToRectangle(points, angle, along, sorted);
      if (mean < least) {
        least = mean;
        best = angle;
      }
    }
  };
  constexpr double degree = 3.14159265358979323846 / 180;
  search(0, 3 * degree, 30);
  search(best - 2.5 * degree, degree / 2, 11);
  return best;
}

} // namespace

void
cuboidsFromSingleFaces(const std::vector<PlanarFace>& faces,
                       const FaceBorders& borders,
                       const Intrinsics& camera,
                       const CuboidHypothesisParameters& parameters,
                       std::vector<CuboidHypothesis>& hypotheses)
{
  detail::FaceEnds ends(faces, borders, camera);
  std::vector<Eigen::Vector2d> outline;
  for (int i = 0; i < static_cast<int>(faces.size()); ++i) {
    const PlanarFace& face = faces[i];
    if (face.pixels < min_pixels)
      continue;
    CuboidHypothesis h;
    h.axes.col(2) = face.normal;
    h.axes.col(0) = face.normal.unitOrthogonal();
    h.axes.col(1) = face.normal.cross(h.axes.col(0));

    outline.clear();
    const int first = borders.first[i], last = borders.first[i + 1];
    const int step = 1 + (last - first) / static_cast<int>(max_points);
    for (int e = first; e < last; e += step) {
      const BorderElement& element = borders.elements[e];
      if (element.kind != BorderKind::occluded && element.kind != BorderKind::cut)
        outline.emplace_back(h.axes.leftCols<2>().transpose() *
                             element.point.cast<double>());
    }
    constexpr std::size_t min_points = 20;
    if (outline.size() < min_points)
      continue;
    h.axes = h.axes * Eigen::AngleAxisd(angleOf(outline), Eigen::Vector3d::UnitZ())
                          .toRotationMatrix();

    const double sigma = parameters.sensor.sigmaZ(face.centroid.z());
    ends.forget();
    for (int f = 0; f < 4; ++f) {
      const detail::FaceEnd end = ends.find(i, h.outward(f), sigma);
      h.end(f) = CuboidHypothesis::side(f) * end.value;
      h.contacts[f] = end.contact;
      h.ends[f] = !end.seen          ? EndSource::bound
                  : end.contact >= 0 ? EndSource::contact
                                     : EndSource::seen;
    }
    const double width = (h.upper - h.lower).head<2>().minCoeff();
    const double length = (h.upper - h.lower).head<2>().maxCoeff();
    if (width < parameters.min_side || length > parameters.max_side)
      continue;
    // so thin that its sides are no evidence
    h.given[2] = face.centroid.z() / std::min(camera.fx, camera.fy);
    h.upper[2] = face.normal.dot(face.centroid);
    h.lower[2] = h.upper[2] - h.given[2];
    h.ends[4] = EndSource::unknown;
    h.ends[5] = EndSource::seen;
    h.faces = {i, -1};
    h.model = CuboidModel::face;
    hypotheses.push_back(h);
  }
}

} // namespace hoist
