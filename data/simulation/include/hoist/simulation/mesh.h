#pragma once

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <vector>

namespace hoist {
namespace simulation {

/** \brief Triangles with materials.
 *
 * Frame: the thing's own, z up, metres. Vertices at creases exist once per side, so
 * that every vertex has one shading normal.
 */
struct Mesh {
  static constexpr std::uint8_t no_face = 255;

  struct Triangle {
    std::array<std::uint32_t, 3> corners; ///< indices of vertices
    std::uint16_t material = 0;           ///< index into the thing's materials
    /// +x 0, -x 1, +y 2, -y 3, +z 4, -z 5 where it lies in a side of the truth's box
    std::uint8_t face = no_face;
  };

  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3f> normals; ///< one per vertex, unit, for shading
  std::vector<Triangle> triangles;

  /** \brief The box along the axes that holds all vertices that triangles use. */
  Eigen::AlignedBox3d bounds() const;

  /** \brief Adds another mesh after \a placement; its materials are renumbered by
   *  + \a first_material. Faces are dropped. */
  void
  append(const Mesh& other, const Eigen::Affine3d& placement, int first_material = 0);

  /** \brief Adds vertices with one normal; returns the first's index. */
  std::uint32_t addFlat(const std::vector<Eigen::Vector3d>& corners);
};

/** \brief How a box is worn. */
struct BoxWear {
  double bevel = 0;    ///< width of the bevel of every edge [m], 0 for none
  double chipping = 0; ///< 0 none .. 1: pieces broken out of the edges
  std::uint64_t seed = 0;
};

/** \brief A box centred on the origin, faces numbered; bevels belong to no face.
 *  \param size full sides [m], > 0; the bevel is kept below a quarter of the least */
Mesh boxMesh(const Eigen::Vector3d& size, const BoxWear& wear = {}, int material = 0);

/** \brief A cross-section of a loft: a rounded rectangle at height z. */
struct Ring {
  double z = 0;         ///< [m]
  double half_x = 0;    ///< [m], >= 0; 0 closes to a point or a line
  double half_y = 0;    ///< [m]
  double roundness = 1; ///< share of the half sides that the corners take: 1 ellipse
  int material = 0;     ///< of the band from this ring to the next
  bool crease = false;  ///< a sharp edge at this ring
  double shift_x = 0;   ///< of the section's centre [m]
  double shift_y = 0;
};

/** \brief The surface through cross-sections, in their order: outside is to the right
 *  of the way from one to the next (upwards: the outer side). Open at both ends unless
 *  the sections there have no width. Normals are those of the surface. */
Mesh loftMesh(const std::vector<Ring>& rings, int segments);

/** \brief A closed round bar along a polyline. \param radius [m], one or one per point
 */
Mesh tubeMesh(const std::vector<Eigen::Vector3d>& points,
              const std::vector<double>& radius,
              int segments = 8,
              int material = 0);

/** \brief An ellipsoid around the origin. */
Mesh ellipsoidMesh(const Eigen::Vector3d& half, int segments = 16, int material = 0);

/** \brief A flat polygon fan through \a corners around the first, seen from both
 *  sides. */
Mesh fanMesh(const std::vector<Eigen::Vector3d>& corners, int material = 0);

} // namespace simulation
} // namespace hoist
