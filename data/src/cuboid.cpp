#include <hoist/data/cuboid.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace hoist {

const char*
toString(CuboidModel model)
{
  switch (model) {
  case CuboidModel::vertex_one:
    return "I";
  case CuboidModel::vertex_two:
    return "II";
  case CuboidModel::faces:
    return "faces";
  case CuboidModel::parallel:
    return "parallel";
  case CuboidModel::face:
    return "face";
  }
  return "";
}

const char*
toString(DimensionSource source)
{
  switch (source) {
  case DimensionSource::measured:
    return "measured";
  case DimensionSource::partial:
    return "partial";
  case DimensionSource::support:
    return "support";
  case DimensionSource::catalogue:
    return "catalogue";
  case DimensionSource::unknown:
    return "unknown";
  }
  return "";
}

Eigen::Matrix<double, 3, 8>
Cuboid::corners() const
{
  Eigen::Matrix<double, 3, 8> out;
  for (int k = 0; k < 8; ++k) {
    Eigen::Vector3d p = center;
    for (int axis = 0; axis < 3; ++axis)
      p += axes.col(axis) * size[axis] * ((k >> axis & 1) != 0 ? 0.5 : -0.5);
    out.col(k) = p;
  }
  return out;
}

const std::array<std::array<int, 2>, 12>&
Cuboid::edges()
{
  static const std::array<std::array<int, 2>, 12> table = {{{0, 1},
                                                            {2, 3},
                                                            {4, 5},
                                                            {6, 7},
                                                            {0, 2},
                                                            {1, 3},
                                                            {4, 6},
                                                            {5, 7},
                                                            {0, 4},
                                                            {1, 5},
                                                            {2, 6},
                                                            {3, 7}}};
  return table;
}

void
canonicalize(Cuboid& cuboid, const Eigen::Vector3d& up)
{
  // Sizes that cannot be told apart are ordered by their angle to up instead.
  const auto alike = [&](int a, int b) {
    const double sigma = std::hypot(cuboid.size_sigma[a], cuboid.size_sigma[b]);
    return std::abs(cuboid.size[a] - cuboid.size[b]) <
           (std::isfinite(sigma) ? sigma : 1e-9);
  };
  const auto level = [&](int a) { return std::abs(cuboid.axes.col(a).dot(up)); };
  std::array<int, 3> order = {0, 1, 2};
  // three elements: bubble sort, because "alike" is not transitive
  for (const int i : {0, 1, 0}) {
    const int a = order[i], b = order[i + 1];
    if (alike(a, b) ? level(a) > level(b) : cuboid.size[a] < cuboid.size[b])
      std::swap(order[i], order[i + 1]);
  }

  const auto sign = [&](const Eigen::Vector3d& axis) {
    // level axes: the camera's -z decides, then +x
    constexpr double tie = 0.1;
    double d = axis.dot(up);
    if (std::abs(d) < tie)
      d = -axis.z();
    if (std::abs(d) < tie)
      d = axis.x();
    return d < 0 ? -1.0 : 1.0;
  };
  const Cuboid old = cuboid;
  std::array<double, 3> signs{};
  signs[0] = sign(old.axes.col(order[0]));
  signs[2] = sign(old.axes.col(order[2]));
  const Eigen::Vector3d first = signs[0] * old.axes.col(order[0]);
  const Eigen::Vector3d last = signs[2] * old.axes.col(order[2]);
  signs[1] = last.cross(first).dot(old.axes.col(order[1])) < 0 ? -1.0 : 1.0;
  for (int i = 0; i < 3; ++i) {
    const int from = order[i];
    cuboid.axes.col(i) = signs[i] * old.axes.col(from);
    cuboid.size[i] = old.size[from];
    cuboid.size_sigma[i] = old.size_sigma[from];
    cuboid.dimension_source[i] = old.dimension_source[from];
    const bool flip = signs[i] < 0;
    cuboid.observed_faces[2 * i] = old.observed_faces[2 * from + (flip ? 1 : 0)];
    cuboid.observed_faces[2 * i + 1] = old.observed_faces[2 * from + (flip ? 0 : 1)];
  }
}

} // namespace hoist
