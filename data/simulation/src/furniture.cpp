// Chairs and plants.
#include "thing_builder.h"

#include <cmath>

namespace hoist {
namespace simulation {
namespace {

using Eigen::Vector3d;

struct ChairParts {
  int seat, frame;
  double width, depth, seat_height, back_height;
};

void
addLegs(ThingBuilder& builder, const ChairParts& c, double radius, double splay)
{
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      builder.add(tubeMesh(
          {{x * (c.depth / 2 + splay - 0.03), y * (c.width / 2 + splay - 0.03), 0},
           {x * (c.depth / 2 - 0.03), y * (c.width / 2 - 0.03), c.seat_height}},
          {radius},
          8,
          c.frame));
}

// Posts at the back with slats or a board between them.
void
addBack(ThingBuilder& builder, const ChairParts& c, bool slats, Random& random)
{
  const double lean = random.uniform(0.03, 0.1), x = -c.depth / 2 + 0.02;
  const double top = c.seat_height + c.back_height;
  for (const double y : {-1.0, 1.0})
    builder.add(tubeMesh({{x, y * (c.width / 2 - 0.025), c.seat_height},
                          {x - lean, y * (c.width / 2 - 0.025), top}},
                         {0.016},
                         8,
                         c.frame));
  const int count = slats ? 2 + random.index(3) : 1;
  for (int i = 0; i < count; ++i) {
    const double height = slats ? 0.06 : 0.55 * c.back_height;
    const double share = slats ? 0.35 + 0.6 * i / std::max(1, count - 1)
                               : 1 - 0.5 * height / c.back_height;
    builder.add(boxMesh({0.02, c.width - 0.05, height}, {0.005, 0, 0}, c.seat),
                Vector3d(x - lean * share, 0, c.seat_height + share * c.back_height));
  }
}

void
addSwivel(ThingBuilder& builder, const ChairParts& c, int black)
{
  for (int i = 0; i < 5; ++i) {
    const double turn = i / 5.0;
    const Vector3d end(0.3 * cosineOfTurns(turn), 0.3 * sineOfTurns(turn), 0.07);
    builder.add(tubeMesh({{0, 0, 0.12}, end}, {0.026, 0.018}, 8, black));
    builder.add(ellipsoidMesh({0.028, 0.028, 0.03}, 10, black),
                Vector3d(end - Vector3d(0, 0, 0.04)));
  }
  builder.add(tubeMesh({{0, 0, 0.1}, {0, 0, c.seat_height}}, {0.028}, 12, black));
  builder.add(tubeMesh({{-c.depth / 2 + 0.05, 0, c.seat_height},
                        {-c.depth / 2 - 0.06, 0, c.seat_height + 0.08},
                        {-c.depth / 2 - 0.04, 0, c.seat_height + 0.3}},
                       {0.022},
                       8,
                       black));
}

void
addCushion(ThingBuilder& builder,
           const Vector3d& half,
           const Vector3d& at,
           int material)
{
  std::vector<Ring> rings = {ringAt(-half.z(), 0, 0, 0.35),
                             ringAt(-half.z(), 0.9 * half.x(), 0.9 * half.y(), 0.35),
                             ringAt(-0.4 * half.z(), half.x(), half.y(), 0.35),
                             ringAt(0.4 * half.z(), half.x(), half.y(), 0.35),
                             ringAt(half.z(), 0.85 * half.x(), 0.85 * half.y(), 0.35),
                             ringAt(half.z(), 0, 0, 0.35)};
  for (Ring& ring : rings)
    ring.material = material;
  builder.add(loftMesh(rings, 28), at);
}

Vector3d
leafPoint(double turn, double r, double z)
{
  return {r * cosineOfTurns(turn), r * sineOfTurns(turn), z};
}

// A leaf that leaves \a foot along \a way and bends down: a narrow fan on each side.
void
addLeaf(ThingBuilder& builder,
        const Vector3d& foot,
        const Vector3d& way,
        double length,
        double width,
        double droop,
        int material)
{
  const Vector3d along = way.normalized();
  Vector3d side = along.cross(Vector3d::UnitZ());
  if (side.squaredNorm() < 1e-6)
    side = Vector3d::UnitX();
  side.normalize();
  constexpr int parts = 5;
  std::vector<Vector3d> left, right;
  for (int i = 0; i <= parts; ++i) {
    const double t = static_cast<double>(i) / parts;
    const Vector3d middle =
        foot + along * (length * t) - Vector3d(0, 0, droop * length * t * t);
    const double half = 0.5 * width * std::sqrt(std::max(0.0, t * (1 - t))) * 2;
    left.emplace_back(middle + side * half - Vector3d(0, 0, 0.15 * half));
    right.emplace_back(middle - side * half - Vector3d(0, 0, 0.15 * half));
  }
  for (int i = 0; i < parts; ++i)
    builder.add(fanMesh({left[static_cast<std::size_t>(i)],
                         left[static_cast<std::size_t>(i) + 1],
                         right[static_cast<std::size_t>(i) + 1],
                         right[static_cast<std::size_t>(i)]},
                        material));
}

double
addPot(ThingBuilder& builder, Random& random, double& radius)
{
  static const std::vector<Rgb> colors = {
      {{176, 96, 66}}, {{70, 72, 76}}, {{215, 212, 204}}, {{90, 110, 130}}};
  const int pot = builder.addMaterial(
      plainMaterial(variedColor(random.pick(colors), 14, random), random, 0.1));
  Material earth = plainMaterial({{70, 54, 42}}, random, 0);
  earth.texture = Texture::soil;
  const int soil = builder.addMaterial(earth);
  radius = random.uniform(0.08, 0.18);
  const double height = radius * random.uniform(1.3, 2),
               round = random.chance(0.7) ? 1 : 0.15;
  const double low = radius * random.uniform(0.65, 0.95);
  std::vector<Ring> rings = {
      ringAt(0, 0, 0, round),
      ringAt(0, low, low, round, true),
      ringAt(height, radius, radius, round, true),
      ringAt(height, 0.9 * radius, 0.9 * radius, round, true),
      ringAt(0.88 * height, 0.88 * radius, 0.88 * radius, round, true)};
  for (Ring& ring : rings)
    ring.material = pot;
  rings.back().material = soil;
  rings.push_back(ringAt(0.9 * height, 0, 0, round));
  builder.add(loftMesh(rings, 28));
  return 0.88 * height;
}

} // namespace

Thing
makeChair(const ThingRequest& request, Random& random)
{
  ThingBuilder builder(request);
  static const std::vector<Rgb> plastic = {{{225, 225, 220}},
                                           {{190, 40, 40}},
                                           {{50, 90, 150}},
                                           {{50, 52, 55}},
                                           {{60, 130, 80}},
                                           {{225, 160, 40}}};
  static const std::vector<Rgb> wood = {
      {{170, 126, 80}}, {{120, 80, 52}}, {{196, 160, 112}}};
  static const std::vector<Rgb> cloth = {
      {{40, 42, 46}}, {{70, 90, 130}}, {{130, 50, 50}}, {{110, 112, 110}}};
  const int variant = variantFor(request, 5, random);
  // wooden, plastic shell, swivel, upholstered; folding for tests
  Material seat = plainMaterial({{0, 0, 0}}, random, 0.15);
  std::string substance = "plastic";
  if (variant == 0) {
    seat.color = pickColor(request, wood, random);
    seat.texture = Texture::wood;
    substance = "wood";
  }
  else if (variant == 2 || variant == 3) {
    seat.color = pickColor(request, cloth, random);
    seat.texture = Texture::fabric;
    seat.gloss = 0;
    substance = "fabric";
  }
  else
    seat.color = pickColor(request, plastic, random);
  seat.stains = request.wear.value_or(random.uniform(0, 0.6));
  ChairParts c{};
  c.seat = builder.addMaterial(seat);
  Material frame = plainMaterial({{125, 128, 130}}, random, 0.4);
  frame.metal = true;
  if (variant == 0)
    frame = seat;
  c.frame = builder.addMaterial(frame);
  const int black = builder.addMaterial(plainMaterial({{34, 34, 36}}, random, 0.2));
  c.width = random.uniform(0.4, 0.5);
  c.depth = random.uniform(0.38, 0.46);
  c.seat_height = random.uniform(0.42, 0.48);
  c.back_height = random.uniform(0.32, 0.5);
  const double h = c.seat_height;
  if (variant == 2) {
    addSwivel(builder, c, black);
    addCushion(builder, {c.depth / 2, c.width / 2, 0.04}, {0, 0, h + 0.03}, c.seat);
    builder.add(boxMesh({0.06, c.width * 0.9, c.back_height}, {0.02, 0, 0}, c.seat),
                Vector3d(-c.depth / 2 - 0.02, 0, h + 0.12 + c.back_height / 2));
    if (random.chance(0.5))
      for (const double y : {-1.0, 1.0})
        builder.add(tubeMesh({{-0.1, y * c.width / 2, h + 0.02},
                              {-0.1, y * (c.width / 2 + 0.05), h + 0.2},
                              {0.16, y * (c.width / 2 + 0.05), h + 0.21}},
                             {0.018},
                             8,
                             black));
  }
  else if (variant == 4) { // folding: crossed legs, a thin seat
    for (const double y : {-1.0, 1.0}) {
      builder.add(tubeMesh({{-c.depth / 2 - 0.05, y * c.width / 2, h + c.back_height},
                            {c.depth / 2 + 0.02, y * c.width / 2, 0}},
                           {0.012},
                           8,
                           c.frame));
      builder.add(tubeMesh({{-c.depth / 2 - 0.04, y * (c.width / 2 - 0.03), 0},
                            {c.depth / 2 - 0.02, y * (c.width / 2 - 0.03), h}},
                           {0.012},
                           8,
                           c.frame));
    }
    builder.add(boxMesh({c.depth * 0.9, c.width - 0.06, 0.02}, {0.006, 0, 0}, c.seat),
                Vector3d(0.03, 0, h));
    builder.add(boxMesh({0.02, c.width, 0.55 * c.back_height}, {0.006, 0, 0}, c.seat),
                Vector3d(-c.depth / 2 - 0.01, 0, h + 0.7 * c.back_height));
  }
  else {
    addLegs(builder, c, variant == 0 ? 0.02 : 0.013, random.uniform(0, 0.05));
    if (variant == 3)
      addCushion(builder, {c.depth / 2, c.width / 2, 0.035}, {0, 0, h + 0.02}, c.seat);
    else
      builder.add(boxMesh({c.depth, c.width, 0.025}, {0.008, 0, 0}, c.seat),
                  Vector3d(0, 0, h));
    addBack(builder, c, variant == 0, random);
    if (random.chance(0.3)) // arms
      for (const double y : {-1.0, 1.0})
        builder.add(tubeMesh({{-c.depth / 2 + 0.02, y * c.width / 2, h + 0.22},
                              {c.depth / 2 - 0.05, y * c.width / 2, h + 0.21},
                              {c.depth / 2 - 0.04, y * c.width / 2, h}},
                             {0.015},
                             8,
                             c.frame));
  }
  builder.thing().substance = substance;
  builder.thing().density = 35;
  return builder.finish();
}

Thing
makePlant(const ThingRequest& request, Random& random)
{
  ThingBuilder builder(request);
  static const std::vector<Rgb> greens = {{{62, 110, 46}},
                                          {{86, 130, 60}},
                                          {{46, 86, 50}},
                                          {{110, 140, 70}},
                                          {{70, 100, 40}}};
  Material leaf = plainMaterial(pickColor(request, greens, random), random, 0.08);
  leaf.texture = Texture::leaf;
  const int green = builder.addMaterial(leaf);
  leaf.color = variedColor(leaf.color, 18, random);
  const int other = builder.addMaterial(leaf);
  const int bark = builder.addMaterial(plainMaterial({{96, 74, 52}}, random, 0));
  double radius = 0;
  const double soil = addPot(builder, random, radius);
  const int variant = variantFor(request, 4, random);
  const double size = radius * random.uniform(2.2, 4.5); // height of the foliage
  if (variant == 0) { // a bush: stems with small leaves
    const int stems = 7 + random.index(8);
    for (int i = 0; i < stems; ++i) {
      const double turn = random.uniform(), out = random.uniform(0.1, 0.7);
      const Vector3d foot = leafPoint(turn, 0.3 * radius, soil);
      const Vector3d top =
          leafPoint(turn, out * size * 0.6, soil + size * random.uniform(0.6, 1));
      builder.add(tubeMesh({foot, (foot + top) / 2 + Vector3d(0, 0, 0.05 * size), top},
                           {0.006, 0.004, 0.002},
                           5,
                           bark));
      for (int k = 0; k < 16; ++k) {
        const Vector3d at = foot + (top - foot) * random.uniform(0.25, 1);
        addLeaf(builder,
                at,
                leafPoint(random.uniform(), 1, random.uniform(-0.1, 0.9)),
                size * random.uniform(0.14, 0.26),
                size * 0.09,
                0.3,
                random.chance(0.5) ? green : other);
      }
    }
  }
  else if (variant == 1) { // long leaves from the ground
    const int leaves = 14 + random.index(16);
    for (int i = 0; i < leaves; ++i)
      addLeaf(builder,
              leafPoint(random.uniform(), 0.25 * radius, soil),
              leafPoint(random.uniform(), random.uniform(0.2, 0.9), 1),
              size * random.uniform(0.7, 1.2),
              radius * random.uniform(0.2, 0.4),
              random.uniform(0.1, 0.7),
              random.chance(0.5) ? green : other);
  }
  else if (variant == 2) { // a small tree
    const double trunk = size * random.uniform(0.5, 0.8);
    builder.add(
        tubeMesh({{0, 0, soil}, {0.02, 0.01, soil + 0.5 * trunk}, {0, 0, soil + trunk}},
                 {0.016, 0.013, 0.01},
                 8,
                 bark));
    const double crown = size * random.uniform(0.3, 0.45);
    for (int i = 0; i < 260; ++i) {
      const Vector3d way =
          leafPoint(random.uniform(), 1, random.uniform(-1.2, 1.6)).normalized();
      const Vector3d at = Vector3d(0, 0, soil + trunk + 0.5 * crown) +
                          way * crown * std::sqrt(random.uniform(0.1, 1));
      addLeaf(builder,
              at,
              way + Vector3d(0, 0, 0.2),
              crown * 0.3,
              crown * 0.16,
              0.4,
              random.chance(0.5) ? green : other);
    }
  }
  else { // few large leaves on stalks
    const int leaves = 7 + random.index(7);
    for (int i = 0; i < leaves; ++i) {
      const double turn = random.uniform();
      const Vector3d foot = leafPoint(turn, 0.15 * radius, soil);
      const Vector3d top = leafPoint(turn,
                                     size * random.uniform(0.15, 0.4),
                                     soil + size * random.uniform(0.4, 0.95));
      builder.add(
          tubeMesh({foot, foot + (top - foot) * 0.6 + Vector3d(0, 0, 0.06), top},
                   {0.007, 0.006, 0.004},
                   6,
                   green));
      addLeaf(builder,
              top,
              leafPoint(turn, 1, 0.25),
              size * 0.42,
              size * 0.3,
              0.5,
              random.chance(0.5) ? green : other);
    }
  }
  Thing& thing = builder.thing();
  thing.substance = "organic";
  thing.density = 60;
  const Rgb color = thing.materials.front().color;
  Thing plant = builder.finish();
  plant.color = color;
  return plant;
}

} // namespace simulation
} // namespace hoist
