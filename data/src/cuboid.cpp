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
  case DimensionSource::bracketed:
    return "bracketed";
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

namespace {

// Directions within this of each other [cosine] count as tied, so that noise does not
// decide; the next criterion does.
constexpr double tie = 0.1;

// Which of two axes of alike length comes first: the one further from up, else the one
// less along the line of sight, else the one that runs from near left to far right.
bool
comesFirst(const Eigen::Vector3d& a,
           const Eigen::Vector3d& b,
           const Eigen::Vector3d& up)
{
  const double level = std::abs(b.dot(up)) - std::abs(a.dot(up));
  if (std::abs(level) > tie)
    return level > 0;
  const double sight = std::abs(b.z()) - std::abs(a.z());
  if (std::abs(sight) > tie)
    return sight > 0;
  return a.x() * a.z() > b.x() * b.z();
}

// The axes from length to height. Sorted by size first, so that the result does not
// depend on the order in which they came; "alike" is not transitive.
std::array<int, 3>
orderAxes(const Cuboid& cuboid, const Eigen::Vector3d& up)
{
  std::array<int, 3> order = {0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return cuboid.size[a] > cuboid.size[b];
  });
  const auto alike = [&](int a, int b) {
    const double sigma = std::hypot(cuboid.size_sigma[a], cuboid.size_sigma[b]);
    return std::abs(cuboid.size[a] - cuboid.size[b]) <
           (std::isfinite(sigma) ? sigma : 1e-9);
  };
  const bool first_two = alike(order[0], order[1]);
  const bool last_two = alike(order[1], order[2]);
  const auto level = [&](int a) { return std::abs(cuboid.axes.col(a).dot(up)); };
  if (first_two && last_two) // the most upright is the height
    std::iter_swap(order.begin() + 2,
                   std::max_element(order.begin(), order.end(), [&](int a, int b) {
                     return level(a) < level(b);
                   }));
  const int i = first_two ? 0 : 1;
  if ((first_two || last_two) &&
      comesFirst(cuboid.axes.col(order[i + 1]), cuboid.axes.col(order[i]), up))
    std::swap(order[i], order[i + 1]);
  return order;
}

// Which end of an axis is its positive one.
double
signOf(const Eigen::Vector3d& axis, const Eigen::Vector3d& up)
{
  for (const double d : {axis.dot(up), -axis.z(), axis.x(), -axis.y()})
    if (std::abs(d) >= tie)
      return d < 0 ? -1.0 : 1.0;
  return 1.0; // not a unit vector
}

} // namespace

void
canonicalize(Cuboid& cuboid, const Eigen::Vector3d& up)
{
  const std::array<int, 3> order = orderAxes(cuboid, up);
  const Cuboid old = cuboid;
  std::array<double, 3> signs{};
  signs[0] = signOf(old.axes.col(order[0]), up);
  signs[2] = signOf(old.axes.col(order[2]), up);
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
