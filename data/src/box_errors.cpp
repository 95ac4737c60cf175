#include <hoist/data/oriented_box.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hoist {
namespace {

// Exact for small angles, where the arc cosine of the trace is not.
double
angleOf(const Eigen::Matrix3d& turn)
{
  const double sine = 0.5 * Eigen::Vector3d(turn(2, 1) - turn(1, 2),
                                            turn(0, 2) - turn(2, 0),
                                            turn(1, 0) - turn(0, 1))
                                .norm();
  return std::atan2(sine, 0.5 * (turn.trace() - 1));
}

// Between lines, not arrows.
double
angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}

std::array<int, 3>
axesOf(const Eigen::Matrix3d& naming)
{
  std::array<int, 3> axis{};
  for (int i = 0; i < 3; ++i)
    naming.col(i).cwiseAbs().maxCoeff(&axis[static_cast<std::size_t>(i)]);
  return axis;
}

} // namespace

const std::vector<Eigen::Matrix3d>&
axisNamings()
{
  static const std::vector<Eigen::Matrix3d> all = [] {
    std::vector<Eigen::Matrix3d> list;
    std::array<int, 3> p = {0, 1, 2};
    do {
      for (int signs = 0; signs < 8; ++signs) {
        Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
        for (int i = 0; i < 3; ++i)
          m(p[i], i) = (signs >> (2 - i) & 1) != 0 ? -1 : 1;
        if (m.determinant() > 0)
          list.push_back(m);
      }
    } while (std::next_permutation(p.begin(), p.end()));
    return list;
  }();
  return all;
}

BoxErrors
boxErrors(const OrientedBox& found, const OrientedBox& truth, ObjectSymmetry symmetry)
{
  constexpr double tie = 1e-11; // [rad]: what rounding makes of equal angles
  BoxErrors best;
  best.rotation = std::numeric_limits<double>::infinity();
  best.center = found.center - truth.center;
  for (const Eigen::Matrix3d& naming : axisNamings()) {
    BoxErrors one = best;
    one.axis = axesOf(naming);
    for (int i = 0; i < 3; ++i)
      one.size[i] = found.size[one.axis[i]] - truth.size[i];
    const Eigen::Matrix3d named = found.axes * naming;
    bool better = false;
    if (symmetry == ObjectSymmetry::box) {
      one.rotation = angleOf(named.transpose() * truth.axes);
      better = one.rotation < best.rotation - tie;
    }
    else {
      const int k =
          static_cast<int>(symmetry) - static_cast<int>(ObjectSymmetry::axis0);
      one.rotation = angleBetween(named.col(k), truth.axes.col(k));
      better = one.rotation < best.rotation - tie ||
               (one.rotation < best.rotation + tie &&
                one.size.squaredNorm() < best.size.squaredNorm());
    }
    if (better)
      best = one;
  }
  return best;
}

} // namespace hoist
