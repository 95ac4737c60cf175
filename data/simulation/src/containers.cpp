// Buckets and recycle bins, empty or with things that protrude.
#include "thing_builder.h"

#include <algorithm>
#include <cmath>

namespace hoist {
namespace simulation {
namespace {

using Eigen::Vector3d;

struct Shell {
  double bottom_x, bottom_y, top_x, top_y; ///< half sides [m]
  double height;
  double roundness;
  double wall = 0.004;
  bool rim = true;
};

// A tapered vessel with walls, open at the top.
void
addShell(ThingBuilder& builder, const Shell& s, int material)
{
  const double lip = s.rim ? 0.012 : 0.0, w = s.wall, r = s.roundness;
  std::vector<Ring> rings = {
      ringAt(0, 0, 0, r),
      ringAt(0, s.bottom_x, s.bottom_y, r, true),
      ringAt(s.height - 2.5 * lip, s.top_x - 0.002, s.top_y - 0.002, r, s.rim)};
  if (s.rim) {
    rings.push_back(
        ringAt(s.height - 2.5 * lip, s.top_x + lip, s.top_y + lip, r, true));
    rings.push_back(ringAt(s.height, s.top_x + lip, s.top_y + lip, r, true));
  }
  else
    rings.push_back(ringAt(s.height, s.top_x, s.top_y, r, true));
  rings.push_back(ringAt(s.height, s.top_x - w, s.top_y - w, r, true));
  rings.push_back(ringAt(0.012, s.bottom_x - w, s.bottom_y - w, r, true));
  rings.push_back(ringAt(0.012, 0, 0, r));
  for (Ring& ring : rings)
    ring.material = material;
  builder.add(loftMesh(rings, 36));
}

// A lid of stuff inside, at a height below the rim.
void
addLevel(ThingBuilder& builder, const Shell& s, double share, int material)
{
  const double x = s.bottom_x + (s.top_x - s.bottom_x) * share - s.wall;
  const double y = s.bottom_y + (s.top_y - s.bottom_y) * share - s.wall;
  std::vector<Ring> rings = {
      ringAt(s.height * share, x, y, s.roundness),
      ringAt(s.height * share + 0.008, 0.4 * x, 0.4 * y, s.roundness),
      ringAt(s.height * share + 0.01, 0, 0, s.roundness)};
  for (Ring& ring : rings)
    ring.material = material;
  builder.add(loftMesh(rings, 28));
}

Vector3d
inOpening(const Shell& s, double share, double z, Random& random)
{
  const double turn = random.uniform(), r = share * std::sqrt(random.uniform());
  return {s.top_x * r * cosineOfTurns(turn), s.top_y * r * sineOfTurns(turn), z};
}

Rgb
anyColor(Random& random)
{
  Rgb any;
  for (unsigned char& channel : any)
    channel = static_cast<unsigned char>(random.uniform(20, 235));
  return any;
}

// Handles of tools and rods that lean over the rim.
void
addRods(ThingBuilder& builder, const Shell& s, Random& random)
{
  const int count = 1 + random.index(4);
  for (int i = 0; i < count; ++i) {
    Material material = plainMaterial(anyColor(random), random, 0.2);
    if (random.chance(0.5)) {
      material.color = {{180, 140, 92}};
      material.texture = Texture::wood;
    }
    const int rod = builder.addMaterial(material);
    const Vector3d foot = inOpening(s, 0.4, 0.03, random);
    Vector3d top =
        inOpening(s, 1.5, s.height * random.uniform(1.25, 1.9) + 0.05, random);
    // it rests on the rim, so it passes inside of it
    const double at_rim = (s.height - foot.z()) / (top.z() - foot.z());
    const Vector3d rim = foot + (top - foot) * at_rim;
    const double out = Eigen::Vector2d(rim.x() / s.top_x, rim.y() / s.top_y).norm();
    if (out > 0.85)
      top.head<2>() = foot.head<2>() + (top - foot).head<2>() * (0.8 / out);
    builder.add(tubeMesh({foot, top}, {random.uniform(0.008, 0.018)}, 10, rod));
    if (random.chance(0.5)) // a head, as of a hammer or a brush
      builder.add(boxMesh({0.1, 0.035, 0.035}, {0.005, 0, 0}, rod), top);
  }
}

void
addHeap(ThingBuilder& builder, const Shell& s, Random& random)
{
  Material material = plainMaterial({{150, 145, 138}}, random, 0);
  material.texture = Texture::concrete;
  const int stone = builder.addMaterial(material);
  addLevel(builder, s, 0.9, stone);
  const double size = std::min(s.top_x, s.top_y);
  for (int i = 0; i < 22; ++i) {
    const Vector3d half = Vector3d(random.uniform(0.16, 0.36),
                                   random.uniform(0.16, 0.36),
                                   random.uniform(0.12, 0.3)) *
                          size;
    Vector3d place = inOpening(s, 0.72, 0, random);
    const double out = Eigen::Vector2d(place.x() / s.top_x, place.y() / s.top_y).norm();
    place.z() = s.height * 0.93 + size * (0.62 - 0.75 * out) * random.uniform(0.3, 1);
    builder.add(stoneMesh(half, stone, random), place);
  }
}

// Rubbish: crumpled paper, bottles, cartons, bags.
void
addRubbish(ThingBuilder& builder, const Shell& s, Random& random)
{
  const double size = std::min(s.top_x, s.top_y);
  const int count = 6 + random.index(8);
  for (int i = 0; i < count; ++i) {
    const Vector3d place =
        inOpening(s, 0.6, s.height + size * random.uniform(-0.3, 0.45), random);
    const int sort = random.index(4);
    Material material = plainMaterial(anyColor(random), random, sort == 1 ? 0.5 : 0.05);
    if (sort == 0)
      material.color = variedColor({{225, 224, 220}}, 12, random);
    if (sort == 2) {
      material.color = {{176, 138, 96}};
      material.texture = Texture::print;
    }
    const int number = builder.addMaterial(material);
    Eigen::Affine3d pose = Eigen::Affine3d::Identity();
    pose.translation() = place;
    const Vector3d lean(random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6), 1);
    pose.linear() =
        Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), lean).toRotationMatrix();
    if (sort == 0)
      builder.add(stoneMesh(Vector3d::Constant(0.3 * size), number, random), pose);
    else if (sort == 1)
      builder.add(tubeMesh({{0, 0, -0.5 * size},
                            {0, 0, 0.3 * size},
                            {0, 0, 0.5 * size},
                            {0, 0, 0.7 * size}},
                           {0.2 * size, 0.2 * size, 0.08 * size, 0.07 * size},
                           14,
                           number),
                  pose);
    else if (sort == 2)
      builder.add(boxMesh({0.7 * size, 0.45 * size, 0.9 * size}, {}, number), pose);
    else
      builder.add(stoneMesh({0.5 * size, 0.45 * size, 0.4 * size}, number, random),
                  pose);
  }
}

void
addBail(ThingBuilder& builder, const Shell& s, bool up, int material)
{
  std::vector<Vector3d> path;
  const double r = s.top_x + 0.012;
  for (int i = 0; i <= 14; ++i) {
    const double turn = 0.5 * i / 14;
    // from one ear to the other, over the top or down along the side
    path.emplace_back(up ? 0.0 : (s.top_y + 0.02) * sineOfTurns(turn),
                      r * cosineOfTurns(turn),
                      s.height - 0.03 + (up ? r : -0.3 * s.height) * sineOfTurns(turn));
  }
  builder.add(tubeMesh(path, {0.004}, 8, material));
}

// Three bent arrows in a triangle, on the side that looks along x.
void
addRecyclingSign(ThingBuilder& builder, const Shell& s, int material)
{
  const double size = 0.4 * std::min(s.top_y, s.height / 2);
  const double z = 0.55 * s.height;
  const double x = s.bottom_x + (s.top_x - s.bottom_x) * 0.55 + 0.001;
  const double slope = (s.top_x - s.bottom_x) / s.height;
  const auto at = [&](double turn, double r) {
    const double up = r * sineOfTurns(turn);
    return Vector3d(x + slope * up, r * cosineOfTurns(turn), z + up);
  };
  for (int k = 0; k < 3; ++k) {
    const double turn = 0.25 + k / 3.0;
    builder.add(fanMesh({at(turn + 0.04, size),
                         at(turn + 0.25, size),
                         at(turn + 0.23, 0.6 * size),
                         at(turn + 0.06, 0.6 * size)},
                        material));
    builder.add(fanMesh({at(turn + 0.24, 1.2 * size),
                         at(turn + 0.31, 0.8 * size),
                         at(turn + 0.22, 0.42 * size)},
                        material));
  }
}

void
makeBucket(ThingBuilder& builder, const ThingRequest& request, Random& random, Shell& s)
{
  static const std::vector<Rgb> plastic = {{{40, 40, 42}},
                                           {{225, 110, 35}},
                                           {{230, 230, 226}},
                                           {{190, 30, 30}},
                                           {{40, 90, 170}},
                                           {{220, 200, 50}}};
  const int variant = variantFor(request, 4, random);
  const bool metal = variant == 1;
  const double top = random.uniform(0.13, 0.17);
  s = {top * random.uniform(0.68, 0.85), 0, top, top, random.uniform(0.24, 0.34), 1};
  s.bottom_y = s.bottom_x;
  if (variant == 2) { // a mortar tub: low and wide
    s.top_x = s.top_y = random.uniform(0.2, 0.26);
    s.bottom_x = s.bottom_y = 0.75 * s.top_x;
  }
  if (variant == 3) { // square with round corners
    s.roundness = 0.35;
    s.top_x = 1.15 * s.top_y;
    s.bottom_x = 1.15 * s.bottom_y;
  }
  Material material = plainMaterial(metal ? variedColor({{165, 168, 170}}, 10, random)
                                          : pickColor(request, plastic, random),
                                    random,
                                    metal ? 0.35 : 0.15);
  material.metal = metal;
  material.stains = request.wear.value_or(random.uniform(0, 1));
  const int body = builder.addMaterial(material);
  const int wire = builder.addMaterial(plainMaterial({{120, 122, 124}}, random, 0.4));
  addShell(builder, s, body);
  builder.closeBox(); // the bail swings: it is not the bucket's size
  addBail(builder, s, random.chance(0.4), wire);
  builder.thing().substance = metal ? "metal" : "plastic";
  if (variant != 3)
    builder.thing().symmetry = ObjectSymmetry::axis2;
}

void
makeBin(ThingBuilder& builder, const ThingRequest& request, Random& random, Shell& s)
{
  static const std::vector<Rgb> colors = {{{30, 90, 170}},
                                          {{40, 120, 60}},
                                          {{45, 45, 48}},
                                          {{220, 180, 40}},
                                          {{130, 134, 138}},
                                          {{170, 40, 40}}};
  const int variant = variantFor(request, 5, random);
  switch (variant) {
  case 0: // beside a desk
    s = {0.11, 0.15, 0.14, 0.19, random.uniform(0.3, 0.42), 0.3};
    break;
  case 1: { // round
    const double top = random.uniform(0.13, 0.2);
    s = {0.8 * top, 0.8 * top, top, top, random.uniform(0.3, 0.6), 1};
    break;
  }
  case 2: // on wheels
    s = {0.2, 0.2, 0.27, 0.25, random.uniform(0.85, 1.0), 0.2};
    break;
  case 3: // a low box
    s = {0.16, 0.24, 0.19, 0.29, random.uniform(0.28, 0.38), 0.2};
    break;
  default: // slim and tall
    s = {0.12, 0.21, 0.14, 0.25, random.uniform(0.6, 0.78), 0.25};
    break;
  }
  const double scale = random.uniform(0.9, 1.1);
  for (double* side : {&s.bottom_x, &s.bottom_y, &s.top_x, &s.top_y})
    *side *= scale;
  Material material = plainMaterial(pickColor(request, colors, random), random, 0.15);
  material.stains = request.wear.value_or(random.uniform(0, 0.7));
  const int body = builder.addMaterial(material);
  const int white = builder.addMaterial(plainMaterial({{232, 232, 228}}, random, 0.05));
  const int black = builder.addMaterial(plainMaterial({{30, 30, 32}}, random, 0.1));
  addShell(builder, s, body);
  if (variant == 2) {
    for (const double side : {-1.0, 1.0})
      builder.add(tubeMesh({{-s.bottom_x - 0.03, side * (s.bottom_y - 0.05), 0.1},
                            {-s.bottom_x - 0.03, side * (s.bottom_y), 0.1}},
                           {0.1},
                           20,
                           black));
    // the lid: closed, or thrown open behind it
    if (random.chance(request.full.value_or(false) ? 0.0 : 0.7))
      builder.add(
          boxMesh({2 * s.top_x + 0.05, 2 * s.top_y + 0.03, 0.04}, {0.01, 0, 0}, body),
          Vector3d(0, 0, s.height + 0.02));
    else
      builder.add(boxMesh({0.035, 2 * s.top_y + 0.03, 2 * s.top_x}, {0.01, 0, 0}, body),
                  Vector3d(-s.top_x - 0.05, 0, s.height - s.top_x));
  }
  if (random.chance(0.7))
    addRecyclingSign(builder, s, white);
  builder.closeBox();
  builder.thing().substance = "plastic";
  if (variant == 1)
    builder.thing().symmetry = ObjectSymmetry::axis2;
}

} // namespace

Thing
makeContainer(const ThingRequest& request, Random& random)
{
  ThingBuilder builder(request);
  const bool bucket = request.kind == "bucket";
  Shell shell{};
  if (bucket)
    makeBucket(builder, request, random, shell);
  else
    makeBin(builder, request, random, shell);
  const bool full = request.full.value_or(random.chance(0.5));
  const Rgb color = builder.thing().materials.front().color;
  if (full) {
    if (!bucket)
      addRubbish(builder, shell, random);
    else if (random.chance(0.5))
      addRods(builder, shell, random);
    else
      addHeap(builder, shell, random);
  }
  else if (random.chance(0.4)) { // something lies deep inside
    Material content =
        plainMaterial(variedColor({{140, 130, 118}}, 40, random), random, 0);
    content.texture = Texture::soil;
    addLevel(builder, shell, random.uniform(0.15, 0.75), builder.addMaterial(content));
  }
  builder.thing().full = full;
  builder.thing().density = full ? 250 : 60;
  Thing thing = builder.finish();
  thing.color = color; // of the vessel, not of what is in it
  return thing;
}

} // namespace simulation
} // namespace hoist
