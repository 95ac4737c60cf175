#include "thing_builder.h"

namespace hoist {
namespace simulation {
namespace {

using Eigen::Vector3d;

// Round bottles for gas: the profile of a turned body.
void
addBottle(ThingBuilder& builder,
          double radius,
          double height,
          bool cap,
          int body,
          int dark)
{
  std::vector<Ring> rings = {ringAt(0, 0, 0),
                             ringAt(0, radius * 0.85, radius * 0.85, 1, true),
                             ringAt(0.04 * height, radius, radius)};
  const double shoulder = height - 1.25 * radius;
  for (int i = 0; i <= 6; ++i) {
    const double turn = 0.25 * i / 6;
    const double r = radius * (0.22 + 0.78 * cosineOfTurns(turn));
    rings.push_back(ringAt(shoulder + 0.8 * radius * sineOfTurns(turn), r, r));
  }
  for (Ring& ring : rings)
    ring.material = body;
  rings.push_back(ringAt(height - 0.3 * radius, 0.2 * radius, 0.2 * radius, 1, true));
  rings.push_back(ringAt(height - 0.3 * radius, 0, 0));
  builder.add(loftMesh(rings, 36));
  if (cap) {
    std::vector<Ring> hood = {
        ringAt(height - 0.5 * radius, 0.4 * radius, 0.4 * radius),
        ringAt(height - 0.05 * radius, 0.36 * radius, 0.36 * radius),
        ringAt(height, 0.2 * radius, 0.2 * radius, 1, true),
        ringAt(height, 0, 0)};
    for (Ring& ring : hood)
      ring.material = dark;
    builder.add(loftMesh(hood, 24));
  }
  else { // a collar with a gap, and the valve
    std::vector<Vector3d> collar;
    for (int i = 0; i <= 18; ++i)
      collar.push_back(
          circlePoint(0.08 + 0.84 * i / 18, 0.62 * radius, height - 0.12 * radius));
    builder.add(tubeMesh(collar, {0.09 * radius}, 8, body));
    for (const double turn : {0.2, 0.5, 0.8})
      builder.add(tubeMesh({circlePoint(turn, 0.6 * radius, height - 0.75 * radius),
                            circlePoint(turn, 0.62 * radius, height - 0.12 * radius)},
                           {0.06 * radius},
                           6,
                           body));
    builder.add(tubeMesh({{0, 0, height - 0.5 * radius}, {0, 0, height - 0.1 * radius}},
                         {0.1 * radius},
                         10,
                         dark));
  }
}

// Cans for fuel: a rounded box with a handle and a spout.
void
addJerryCan(ThingBuilder& builder,
            const Vector3d& half,
            bool metal,
            int body,
            int dark,
            Random& random)
{
  const double h = 2 * half.z() * 0.86, round = metal ? 0.2 : 0.45;
  std::vector<Ring> rings = {ringAt(0, 0, 0, round),
                             ringAt(0, half.x() * 0.94, half.y() * 0.92, round),
                             ringAt(0.03, half.x(), half.y(), round)};
  if (!metal)
    for (const double share : {0.35, 0.65}) { // grooves
      rings.push_back(ringAt(h * share - 0.01, half.x(), half.y(), round));
      rings.push_back(ringAt(h * share, half.x() * 0.97, half.y() * 0.96, round));
      rings.push_back(ringAt(h * share + 0.01, half.x(), half.y(), round));
    }
  rings.push_back(ringAt(h - 0.04, half.x(), half.y(), round));
  rings.push_back(ringAt(h, half.x() * 0.9, half.y() * 0.88, round));
  rings.push_back(ringAt(h, 0, 0, round));
  for (Ring& ring : rings)
    ring.material = body;
  builder.add(loftMesh(rings, 28));
  const double top = 2 * half.z() * 0.985;
  const int handles = metal ? 3 : 1;
  for (int i = 0; i < handles; ++i) {
    const double y = handles == 1 ? 0 : (i - 1) * half.y() * 0.6;
    builder.add(tubeMesh({{-0.75 * half.x(), y, h - 0.02},
                          {-0.7 * half.x(), y, top - 0.015},
                          {0.25 * half.x(), y, top - 0.015},
                          {0.32 * half.x(), y, h - 0.02}},
                         {0.014},
                         10,
                         body));
  }
  builder.add(
      tubeMesh({{0.68 * half.x(), 0, h - 0.03}, {0.76 * half.x(), 0, top - 0.004}},
               {0.028},
               14,
               random.chance(0.6) ? dark : body));
}

} // namespace

Thing
makeGasContainer(const ThingRequest& request, Random& random)
{
  ThingBuilder builder(request);
  const int variant = variantFor(request, 5, random);
  const bool metal = variant != 2;
  static const std::vector<Rgb> steel = {{{170, 60, 44}},
                                         {{130, 140, 146}},
                                         {{40, 80, 140}},
                                         {{210, 210, 205}},
                                         {{70, 90, 60}},
                                         {{220, 150, 40}}};
  static const std::vector<Rgb> plastic = {{{196, 30, 30}},
                                           {{220, 190, 40}},
                                           {{30, 80, 160}},
                                           {{40, 110, 60}},
                                           {{40, 40, 42}}};
  Material material =
      plainMaterial(pickColor(request, metal ? steel : plastic, random), random, 0.3);
  const double wear = request.wear.value_or(random.uniform(0, 1));
  material.stains = 0.7 * wear;
  if (metal && wear > 0.6) {
    material.texture = Texture::rust;
    material.second = {{112, 62, 38}};
  }
  const int body = builder.addMaterial(material);
  const int dark = builder.addMaterial(plainMaterial({{60, 60, 62}}, random, 0.2));
  switch (variant) {
  case 0:
    addBottle(builder,
              random.uniform(0.13, 0.16),
              random.uniform(0.45, 0.6),
              false,
              body,
              dark);
    break;
  case 1:
    addBottle(
        builder, random.uniform(0.1, 0.12), random.uniform(1.0, 1.5), true, body, dark);
    break;
  case 2: // plastic, for fuel
    addJerryCan(builder,
                {random.uniform(0.12, 0.19),
                 random.uniform(0.07, 0.11),
                 random.uniform(0.13, 0.22)},
                false,
                body,
                dark,
                random);
    break;
  case 3: // steel, for fuel
    addJerryCan(builder,
                {random.uniform(0.16, 0.18),
                 random.uniform(0.075, 0.09),
                 random.uniform(0.21, 0.24)},
                true,
                body,
                dark,
                random);
    break;
  default: // a short, wide bottle
    addBottle(builder,
              random.uniform(0.11, 0.19),
              random.uniform(0.28, 0.4),
              random.chance(0.5),
              body,
              dark);
    break;
  }
  Thing& thing = builder.thing();
  thing.substance = metal ? "metal" : "plastic";
  thing.density = metal ? 650 : 250;
  if (variant != 2 && variant != 3)
    thing.symmetry = ObjectSymmetry::axis2;
  return builder.finish();
}

} // namespace simulation
} // namespace hoist
