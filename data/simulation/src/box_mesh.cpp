#include <hoist/simulation/mesh.h>
#include <hoist/simulation/random.h>

#include <algorithm>
#include <cmath>

namespace hoist {
namespace simulation {
namespace {

// A place on a worn edge: how far along it, and how wide the bevel is there.
struct Node {
  double along;
  double width;
};

// Edges along one axis, by the signs of the two axes after it (0 for -, 1 for +).
using Edges = std::array<std::array<std::array<std::vector<Node>, 2>, 2>, 3>;

// Pieces broken out: each widens the bevel around its middle.
void
chip(std::vector<Node>& nodes, double limit, double chipping, Random& random)
{
  const double length = nodes.back().along - nodes.front().along;
  const double expected = 2.5 * chipping * length + 0.6 * chipping;
  const int count = static_cast<int>(expected) +
                    (random.chance(expected - std::floor(expected)) ? 1 : 0);
  for (int k = 0; k < count; ++k) {
    const double middle = nodes.front().along + length * random.uniform();
    const double reach = random.uniform(0.015, 0.06),
                 depth = random.uniform(0.004, 0.022);
    for (std::size_t i = 1; i + 1 < nodes.size(); ++i) {
      const double d = std::abs(nodes[i].along - middle) / reach;
      if (d < 1)
        nodes[i].width = std::min(limit, nodes[i].width + depth * (1 - d * d));
    }
  }
}

Edges
wornEdges(const Eigen::Vector3d& half, const BoxWear& wear)
{
  const double limit = half.minCoeff() / 2;
  const double bevel = std::min(wear.bevel, limit * 0.8);
  Random random(subSeed(wear.seed, "edges"));
  std::array<double, 8> corner{};
  for (double& width : corner)
    width = bevel * (wear.chipping > 0 ? random.uniform(0.7, 1.5) : 1.0);
  Edges edges;
  for (int a = 0; a < 3; ++a)
    for (int s = 0; s < 2; ++s)
      for (int t = 0; t < 2; ++t) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        const int low = (s << b) | (t << c), high = low | (1 << a);
        const double from = -half[a] + corner[low], to = half[a] - corner[high];
        std::vector<Node>& nodes = edges[a][s][t];
        const int parts =
            wear.chipping > 0
                ? std::clamp(static_cast<int>((to - from) / 0.012), 1, 160)
                : 1;
        for (int i = 0; i <= parts; ++i) {
          const double share = static_cast<double>(i) / parts;
          double width = corner[low] + (corner[high] - corner[low]) * share;
          if (i > 0 && i < parts)
            width = std::min(limit, width + bevel * random.uniform(-0.3, 0.5));
          nodes.push_back({from + (to - from) * share, width});
        }
        if (wear.chipping > 0)
          chip(nodes, limit, wear.chipping, random);
      }
  return edges;
}

class BoxBuilder {
public:
  BoxBuilder(const Eigen::Vector3d& size, const BoxWear& wear, int material)
  : half_(size / 2), edges_(wornEdges(half_, wear)), material_(material)
  {
  }

  Mesh
  build(bool bevelled)
  {
    for (int axis = 0; axis < 3; ++axis)
      for (int sign = 0; sign < 2; ++sign)
        addFace(axis, sign);
    if (bevelled) {
      for (int axis = 0; axis < 3; ++axis)
        for (int s = 0; s < 2; ++s)
          for (int t = 0; t < 2; ++t)
            addEdge(axis, s, t);
      for (int corner = 0; corner < 8; ++corner)
        addCorner(corner);
    }
    return std::move(mesh_);
  }

private:
  // The node's place on the face normal to axis n, for an edge along axis a.
  Eigen::Vector3d
  onFace(int a, int s, int t, const Node& node, int n) const
  {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    Eigen::Vector3d p;
    p[a] = node.along;
    p[b] = (s ? 1 : -1) * (half_[b] - (n == b ? 0 : node.width));
    p[c] = (t ? 1 : -1) * (half_[c] - (n == c ? 0 : node.width));
    return p;
  }

  void
  addTriangle(std::uint32_t i, std::uint32_t j, std::uint32_t k, int face)
  {
    mesh_.triangles.push_back({{{i, j, k}},
                               static_cast<std::uint16_t>(material_),
                               static_cast<std::uint8_t>(face)});
  }

  void
  addFace(int n, int sign)
  {
    // around the face, anticlockwise for its positive side
    const int u = (n + 1) % 3, v = (n + 2) % 3;
    std::vector<Eigen::Vector3d> loop;
    const auto walk = [&](int along, int side, bool forward) {
      // the two signs in the order of the edge's own two other axes
      const bool first_is_normal = (along + 1) % 3 == n;
      const int s = first_is_normal ? sign : side, t = first_is_normal ? side : sign;
      std::vector<Node> nodes = edges_[along][s][t];
      if (!forward)
        std::reverse(nodes.begin(), nodes.end());
      for (std::size_t i = 0; i + 1 < nodes.size(); ++i)
        loop.push_back(onFace(along, s, t, nodes[i], n));
    };
    walk(u, 0, true);
    walk(v, 1, true);
    walk(u, 1, false);
    walk(v, 0, false);
    if (sign == 0)
      std::reverse(loop.begin(), loop.end());
    const auto count = static_cast<std::uint32_t>(loop.size());
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    centre[n] = (sign ? 1 : -1) * half_[n];
    const std::uint32_t first = mesh_.addFlat(loop);
    const std::uint32_t middle = mesh_.addFlat({centre});
    mesh_.normals[middle] = mesh_.normals[first];
    for (std::uint32_t i = 0; i < count; ++i)
      addTriangle(middle, first + i, first + (i + 1) % count, 2 * n + (sign ? 0 : 1));
  }

  void
  addEdge(int a, int s, int t)
  {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    const std::vector<Node>& nodes = edges_[a][s][t];
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      std::vector<Eigen::Vector3d> quad = {onFace(a, s, t, nodes[i], b),
                                           onFace(a, s, t, nodes[i + 1], b),
                                           onFace(a, s, t, nodes[i + 1], c),
                                           onFace(a, s, t, nodes[i], c)};
      if (s == t)
        std::reverse(quad.begin(), quad.end());
      const std::uint32_t first = mesh_.addFlat(quad);
      addTriangle(first, first + 1, first + 2, Mesh::no_face);
      addTriangle(first, first + 2, first + 3, Mesh::no_face);
    }
  }

  void
  addCorner(int corner)
  {
    std::vector<Eigen::Vector3d> points;
    for (int n = 0; n < 3; ++n) {
      // the edge along the axis after n ends there, on the face normal to n
      const int a = (n + 1) % 3, s = corner >> ((a + 1) % 3) & 1,
                t = corner >> ((a + 2) % 3) & 1;
      const std::vector<Node>& nodes = edges_[a][s][t];
      points.push_back(
          onFace(a, s, t, (corner >> a & 1) ? nodes.back() : nodes.front(), n));
    }
    const int negative = 3 - ((corner & 1) + (corner >> 1 & 1) + (corner >> 2 & 1));
    if (negative % 2 == 1)
      std::reverse(points.begin(), points.end());
    const std::uint32_t first = mesh_.addFlat(points);
    addTriangle(first, first + 1, first + 2, Mesh::no_face);
  }

  Eigen::Vector3d half_;
  Edges edges_;
  int material_;
  Mesh mesh_;
};

} // namespace

Mesh
boxMesh(const Eigen::Vector3d& size, const BoxWear& wear, int material)
{
  return BoxBuilder(size, wear, material).build(wear.bevel > 0 || wear.chipping > 0);
}

} // namespace simulation
} // namespace hoist
