#include "thing_builder.h"

#include <algorithm>
#include <cmath>

namespace hoist {
namespace simulation {
namespace {

Rgb
mostlyColored(const Mesh& mesh, const std::vector<Material>& materials)
{
  std::vector<double> areas(materials.size());
  for (const Mesh::Triangle& t : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.vertices[t.corners[0]];
    areas[t.material] +=
        (mesh.vertices[t.corners[1]] - a).cross(mesh.vertices[t.corners[2]] - a).norm();
  }
  const auto most = std::max_element(areas.begin(), areas.end()) - areas.begin();
  return materials[static_cast<std::size_t>(most)].color;
}

} // namespace

Thing
ThingBuilder::finish(bool cuboid)
{
  Eigen::AlignedBox3d box = body_.isEmpty() ? mesh_.bounds() : body_;
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  if (request_.size)
    scale = request_.size->cwiseQuotient(box.sizes().cwiseMax(1e-6));
  const Eigen::Vector3d foot(box.center().x(), box.center().y(), box.min().z());
  for (Eigen::Vector3d& vertex : mesh_.vertices)
    vertex = (vertex - foot).cwiseProduct(scale);
  for (Eigen::Vector3f& normal : mesh_.normals)
    normal = normal.cwiseQuotient(scale.cast<float>()).normalized();
  box.min() = (box.min() - foot).cwiseProduct(scale);
  box.max() = (box.max() - foot).cwiseProduct(scale);
  thing_.color = mostlyColored(mesh_, thing_.materials);
  thing_.box_center = box.center();
  thing_.box_size = box.sizes();
  thing_.is_cuboid = cuboid;
  if (!cuboid)
    for (Mesh::Triangle& triangle : mesh_.triangles)
      triangle.face = Mesh::no_face;
  thing_.mesh = std::make_shared<const Mesh>(std::move(mesh_));
  return std::move(thing_);
}

Rgb
variedColor(const Rgb& color, double spread, Random& random)
{
  const double all = random.uniform(-spread, spread);
  Rgb out;
  for (std::size_t i = 0; i < 3; ++i)
    out[i] = static_cast<unsigned char>(std::clamp(
        std::floor(color[i] + all + random.uniform(-spread, spread) / 2), 4.0, 250.0));
  return out;
}

int
variantFor(const ThingRequest& request, int count, Random& random)
{
  const int held_out = std::max(1, count / 3);
  if (request.split == "train")
    return random.index(count - held_out);
  if (request.split == "test")
    return count - held_out + random.index(held_out);
  return random.index(count);
}

Rgb
pickColor(const ThingRequest& request, const std::vector<Rgb>& colors, Random& random)
{
  return request.color ? *request.color : variedColor(random.pick(colors), 16, random);
}

Mesh
stoneMesh(const Eigen::Vector3d& half, int material, Random& random)
{
  Mesh stone = ellipsoidMesh(half, 8, material);
  const std::uint64_t seed = random.bits();
  for (Eigen::Vector3d& p : stone.vertices) // alike where a vertex is there twice
    p *= 1 + 0.4 * (hash01(seed,
                           static_cast<std::int64_t>(std::floor(p.x() * 1e5)),
                           static_cast<std::int64_t>(std::floor(p.y() * 1e5)),
                           static_cast<std::int64_t>(std::floor(p.z() * 1e5))) -
                    0.5);
  return stone;
}

} // namespace simulation
} // namespace hoist
