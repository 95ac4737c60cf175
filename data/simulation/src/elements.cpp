// Lifting elements: things that are cuboids.
#include "thing_builder.h"

#include <algorithm>

namespace hoist {
namespace simulation {
namespace {

struct ElementKind {
  const char* kind;
  Eigen::Vector3d low, high; ///< sides [m]
  Texture texture;
  const char* substance;
  double density; ///< of the box [kg/m3]
  double bevel;   ///< [m]
  double wear;
};

const std::vector<ElementKind>&
elementKinds()
{
  static const std::vector<ElementKind> kinds = {
      {"slab",
       {1.4, 0.8, 0.12},
       {3.2, 1.6, 0.25},
       Texture::concrete,
       "concrete",
       2400,
       0.012,
       0.5},
      {"column",
       {1.8, 0.25, 0.25},
       {4.0, 0.45, 0.45},
       Texture::concrete,
       "concrete",
       2400,
       0.018,
       0.5},
      {"beam",
       {1.8, 0.2, 0.3},
       {4.0, 0.35, 0.6},
       Texture::concrete,
       "concrete",
       2400,
       0.014,
       0.5},
      {"block",
       {0.5, 0.4, 0.35},
       {1.6, 0.8, 0.8},
       Texture::concrete,
       "concrete",
       2400,
       0.015,
       0.7},
      {"bricks",
       {0.75, 0.75, 0.5},
       {1.1, 1.0, 1.0},
       Texture::brick,
       "brick",
       1700,
       0.004,
       0.3},
      {"carton",
       {0.2, 0.15, 0.1},
       {0.7, 0.5, 0.5},
       Texture::print,
       "cardboard",
       180,
       0.004,
       0.0},
      {"crate",
       {0.5, 0.4, 0.3},
       {1.2, 0.8, 0.8},
       Texture::wood,
       "wood",
       300,
       0.004,
       0.1},
      {"timber",
       {1.2, 0.08, 0.08},
       {2.4, 0.12, 0.12},
       Texture::wood,
       "wood",
       550,
       0.003,
       0.2},
      {"box", {0.2, 0.2, 0.2}, {0.6, 0.5, 0.5}, Texture::plain, "plastic", 300, 0, 0},
  };
  return kinds;
}

Rgb
colorFor(Texture texture, Random& random)
{
  static const std::vector<Rgb> concrete = {
      {{152, 148, 141}}, {{165, 160, 150}}, {{130, 130, 128}}, {{176, 172, 165}}};
  static const std::vector<Rgb> wood = {
      {{176, 134, 88}}, {{150, 110, 70}}, {{196, 160, 112}}, {{120, 100, 80}}};
  static const std::vector<Rgb> carton = {
      {{178, 138, 94}}, {{160, 122, 82}}, {{196, 160, 116}}, {{225, 222, 215}}};
  static const std::vector<Rgb> brick = {
      {{150, 76, 54}}, {{165, 92, 66}}, {{176, 150, 120}}};
  static const std::vector<Rgb> steel = {
      {{60, 90, 130}}, {{150, 60, 40}}, {{110, 115, 118}}, {{180, 140, 30}}};
  switch (texture) {
  case Texture::wood:
    return variedColor(random.pick(wood), 14, random);
  case Texture::print:
    return variedColor(random.pick(carton), 10, random);
  case Texture::brick:
    return variedColor(random.pick(brick), 12, random);
  case Texture::rust:
    return variedColor(random.pick(steel), 10, random);
  case Texture::plain: {
    Rgb any;
    for (unsigned char& channel : any)
      channel = static_cast<unsigned char>(random.uniform(40, 220));
    return any;
  }
  default:
    return variedColor(random.pick(concrete), 10, random);
  }
}

Material
materialFor(Texture texture, const ThingRequest& request, double wear, Random& random)
{
  Material material;
  material.texture = texture;
  material.color = colorFor(texture, random);
  if (request.color)
    material.color = *request.color;
  material.seed = random.bits();
  switch (texture) {
  case Texture::print: {
    static const std::vector<Rgb> inks = {{{30, 60, 140}},
                                          {{150, 30, 30}},
                                          {{30, 30, 30}},
                                          {{20, 100, 60}},
                                          {{220, 120, 20}}};
    material.second = random.pick(inks);
    break;
  }
  case Texture::brick:
    material.second = variedColor({{170, 165, 155}}, 15, random);
    break;
  case Texture::rust:
    material.second = variedColor({{112, 62, 38}}, 12, random);
    material.gloss = 0.15;
    break;
  case Texture::plain:
    material.gloss = random.uniform(0, 0.3);
    break;
  default:
    break;
  }
  material.stains = wear * random.uniform(0.1, 0.9);
  material.contrast = random.uniform(0.8, 1.3);
  return material;
}

// An open pallet: boards on blocks. Its box is what is annotated, and never counts.
Thing
makePallet(const ThingRequest& request, Random& random)
{
  ThingBuilder builder(request);
  ThingRequest plain;
  const int wood = builder.addMaterial(materialFor(Texture::wood, plain, 0.6, random));
  const Eigen::Vector3d size = request.size.value_or(Eigen::Vector3d(1.2, 0.8, 0.144));
  const double board = 0.022, width = 0.1;
  const int boards = 5;
  for (int i = 0; i < boards; ++i) {
    const double y = (size.y() - width) * (static_cast<double>(i) / (boards - 1) - 0.5);
    builder.add(boxMesh({size.x(), width, board}, {}, wood),
                Eigen::Vector3d(0, y, size.z() - board / 2));
  }
  for (int i = -1; i <= 1; ++i) {
    const double x = i * (size.x() - width) / 2;
    builder.add(boxMesh({width, size.y(), board}, {}, wood),
                Eigen::Vector3d(x, 0, size.z() - 1.5 * board));
    for (int j = -1; j <= 1; ++j)
      builder.add(
          boxMesh({width, width, size.z() - 3 * board}, {}, wood),
          Eigen::Vector3d(x, j * (size.y() - width) / 2, size.z() / 2 - board / 2));
  }
  for (int j = -1; j <= 1; ++j)
    builder.add(boxMesh({size.x(), width, board}, {}, wood),
                Eigen::Vector3d(0, j * (size.y() - width) / 2, board / 2));
  Thing& thing = builder.thing();
  thing.substance = "wood";
  thing.annotated = true;
  thing.minor = true;
  thing.density = 180;
  return builder.finish();
}

} // namespace

Thing
makeElement(const ThingRequest& request, Random& random)
{
  if (request.kind == "pallet")
    return makePallet(request, random);
  const std::vector<ElementKind>& kinds = elementKinds();
  const auto found =
      std::find_if(kinds.begin(), kinds.end(), [&](const ElementKind& kind) {
        return request.kind == kind.kind;
      });
  const ElementKind& kind = found == kinds.end() ? kinds.back() : *found;
  Eigen::Vector3d size;
  for (int i = 0; i < 3; ++i)
    size[i] = random.uniform(kind.low[i], kind.high[i]);
  if (request.kind == "column")
    size.z() = size.y();
  if (request.size)
    size = *request.size;
  const double wear = request.wear.value_or(kind.wear * random.uniform(0.2, 1.0));
  BoxWear box_wear;
  box_wear.bevel =
      wear > 0 || kind.bevel > 0.01
          ? std::min(kind.bevel * random.uniform(0.5, 1.0), size.minCoeff() * 0.06)
          : 0;
  box_wear.chipping = kind.texture == Texture::concrete ? wear : 0.3 * wear;
  box_wear.seed = random.bits();
  if (request.wear && *request.wear == 0)
    box_wear = {};

  ThingBuilder builder(request);
  const Texture texture = request.texture.value_or(kind.texture);
  builder.addMaterial(materialFor(texture, request, wear, random));
  builder.mesh() = boxMesh(size, box_wear);
  Thing& thing = builder.thing();
  thing.annotated = true;
  thing.minor = request.kind == "timber";
  thing.density = kind.density * random.uniform(0.95, 1.05);
  thing.substance = kind.substance;
  if (request.texture == Texture::wood)
    thing.substance = "wood";
  else if (request.texture == Texture::concrete)
    thing.substance = "concrete";
  else if (request.texture == Texture::rust)
    thing.substance = "metal";
  return builder.finish(true);
}

} // namespace simulation
} // namespace hoist
