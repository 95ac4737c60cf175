#include <hoist/simulation/mesh.h>

namespace hoist {
namespace simulation {

Eigen::AlignedBox3d
Mesh::bounds() const
{
  Eigen::AlignedBox3d box;
  for (const Triangle& triangle : triangles)
    for (const std::uint32_t corner : triangle.corners)
      box.extend(vertices[corner]);
  return box;
}

void
Mesh::append(const Mesh& other, const Eigen::Affine3d& placement, int first_material)
{
  const auto offset = static_cast<std::uint32_t>(vertices.size());
  // normals go with the inverse transpose, a mirror image turns triangles around
  const Eigen::Matrix3d turn = placement.linear().inverse().transpose();
  const bool mirrored = placement.linear().determinant() < 0;
  for (const Eigen::Vector3d& vertex : other.vertices)
    vertices.emplace_back(placement * vertex);
  for (const Eigen::Vector3f& normal : other.normals)
    normals.emplace_back((turn * normal.cast<double>()).normalized().cast<float>());
  for (Triangle triangle : other.triangles) {
    for (std::uint32_t& corner : triangle.corners)
      corner += offset;
    if (mirrored)
      std::swap(triangle.corners[1], triangle.corners[2]);
    triangle.material = static_cast<std::uint16_t>(triangle.material + first_material);
    triangle.face = no_face;
    triangles.push_back(triangle);
  }
}

std::uint32_t
Mesh::addFlat(const std::vector<Eigen::Vector3d>& corners)
{
  const auto first = static_cast<std::uint32_t>(vertices.size());
  // Newell's normal: it does not mind corners on one line
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i)
    normal += corners[i].cross(corners[(i + 1) % corners.size()]);
  if (normal.squaredNorm() > 0)
    normal.normalize();
  vertices.insert(vertices.end(), corners.begin(), corners.end());
  normals.insert(normals.end(), corners.size(), normal.cast<float>());
  return first;
}

} // namespace simulation
} // namespace hoist
