#include "site.h"

#include <algorithm>
#include <cmath>

namespace hoist {
namespace simulation {

Site::Site(const Description& description, std::uint64_t seed)
: description_(description)
, random_(subSeed(seed, "site"))
, area_(description.area[0], description.area[1])
{
  scene_.seed = seed;
  addGround();
  addWalls();
  if (description_.table)
    addTable();
  for (std::size_t g = 0; g < description_.things.size(); ++g) {
    const int count = description_.things[g].count.drawWhole(random_);
    addGroup(static_cast<int>(g), count, nullptr);
  }
}

void
Site::addGround()
{
  Thing ground;
  ground.kind = ground.name = "ground";
  Material material;
  material.texture = random_.pick(description_.ground);
  static const std::vector<Rgb> soils = {
      {{134, 112, 88}}, {{150, 130, 104}}, {{112, 98, 82}}, {{160, 146, 122}}};
  static const std::vector<Rgb> greys = {
      {{138, 136, 132}}, {{120, 119, 117}}, {{155, 151, 145}}, {{104, 104, 106}}};
  material.color = random_.pick(material.texture == Texture::soil ? soils : greys);
  if (material.texture == Texture::wood)
    material.color = {{158, 120, 82}};
  if (!description_.ground_colors.empty())
    material.color = random_.pick(description_.ground_colors);
  material.stains = random_.uniform(0, 0.7);
  material.seed = random_.bits();
  ground.materials.push_back(material);
  auto mesh = std::make_shared<Mesh>();
  constexpr double half = 150;
  mesh->addFlat(
      {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}});
  mesh->triangles.push_back({{{0, 1, 2}}, 0, Mesh::no_face});
  mesh->triangles.push_back({{{0, 2, 3}}, 0, Mesh::no_face});
  ground.mesh = mesh;
  ground.box_size = {2 * half, 2 * half, 0.01};
  scene_.things.push_back(ground);
}

void
Site::addWalls()
{
  if (!description_.walls)
    return;
  static const std::vector<Rgb> paints = {
      {{205, 200, 190}}, {{180, 185, 188}}, {{225, 222, 214}}, {{170, 160, 140}}};
  Material material;
  material.texture = random_.chance(0.5)   ? Texture::plaster
                     : random_.chance(0.5) ? Texture::concrete
                                           : Texture::brick;
  material.color = random_.pick(paints);
  if (material.texture == Texture::brick) {
    material.color = {{150, 84, 62}};
    material.second = {{165, 160, 150}};
  }
  material.seed = random_.bits();
  const int n = std::min(4, description_.walls->drawWhole(random_));
  const int first = random_.index(4);
  for (int k = 0; k < n; ++k) {
    const int side = (first + k) % 4;
    const bool along_x = side % 2 == 0;
    const double sign = side < 2 ? 1 : -1;
    const double off =
        description_.area[along_x ? 1 : 0] / 2 + description_.wall_distance;
    const double length =
        description_.area[along_x ? 0 : 1] + 2 * description_.wall_distance + 0.4;
    Thing wall;
    wall.kind = "wall";
    wall.name = "wall-" + std::to_string(k + 1);
    const double height = description_.wall_height;
    wall.box_size = along_x ? Eigen::Vector3d(length, 0.2, height)
                            : Eigen::Vector3d(0.2, length, height);
    wall.materials.push_back(material);
    wall.mesh = std::make_shared<const Mesh>(boxMesh(wall.box_size));
    wall.pose.translation() = along_x
                                  ? Eigen::Vector3d(0, sign * (off + 0.1), height / 2)
                                  : Eigen::Vector3d(sign * (off + 0.1), 0, height / 2);
    scene_.things.push_back(wall);
  }
}

void
Site::addTable()
{
  const std::array<Range, 3>& size = *description_.table;
  const Eigen::Vector3d sides(
      size[0].draw(random_), size[1].draw(random_), size[2].draw(random_));
  Material material;
  static const std::vector<Rgb> tops = {
      {{182, 146, 104}}, {{200, 198, 192}}, {{120, 86, 58}}, {{90, 92, 96}}};
  material.color = random_.pick(tops);
  material.texture = random_.chance(0.5) ? Texture::wood : Texture::plain;
  material.gloss = random_.uniform(0, 0.25);
  material.contrast = 0.5;
  material.seed = random_.bits();
  // its parts are boxes that a recogniser may rightly report: true, but no hit and no
  // miss
  const auto addPart = [&](const std::string& name,
                           const Eigen::Vector3d& size,
                           const Eigen::Vector3d& center) {
    Thing part;
    part.kind = "table";
    part.name = name;
    part.annotated = part.is_cuboid = part.minor = true;
    part.label = next_label_++;
    part.substance = material.texture == Texture::wood ? "wood" : "plastic";
    part.color = material.color;
    part.materials.push_back(material);
    part.mesh = std::make_shared<const Mesh>(boxMesh(size));
    part.box_size = size;
    part.pose.translation() = center;
    scene_.things.push_back(part);
  };
  constexpr double thickness = 0.03;
  addPart(
      "table", {sides.x(), sides.y(), thickness}, {0, 0, sides.z() - thickness / 2});
  const Eigen::Vector3d leg(0.05, 0.05, sides.z() - thickness);
  for (int k = 0; k < 4; ++k)
    addPart("table-leg-" + std::to_string(k + 1),
            leg,
            {(k & 1 ? 0.5 : -0.5) * (sides.x() - 0.12),
             (k & 2 ? 0.5 : -0.5) * (sides.y() - 0.12),
             leg.z() / 2});
  scene_.support_height = sides.z();
  area_ = sides.head<2>();
}

bool
Site::free(const Eigen::Vector3d& eye) const
{
  Footprint here;
  here.center = eye.head<2>();
  here.half = {0.3, 0.3};
  return !collides(here, eye.z() - 0.3, eye.z() + 0.3);
}

} // namespace simulation
} // namespace hoist
