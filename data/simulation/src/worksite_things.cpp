#include "thing_builder.h"

#include <algorithm>
#include <cmath>

namespace hoist {
namespace simulation {
namespace {

using Eigen::Vector3d;

} // namespace

Thing
makeCone(const ThingRequest& request, Random& random)
{
  ThingBuilder builder(request);
  static const std::vector<Rgb> colors = {{{226, 84, 30}},
                                          {{236, 110, 36}},
                                          {{205, 50, 40}},
                                          {{232, 196, 40}},
                                          {{200, 220, 40}}};
  const int body = builder.addMaterial(
      plainMaterial(pickColor(request, colors, random), random, 0.12));
  const int band = builder.addMaterial(plainMaterial({{226, 226, 222}}, random, 0.3));
  const int foot = builder.addMaterial(plainMaterial({{38, 38, 40}}, random, 0.05));
  const double dirt = request.wear.value_or(random.uniform(0, 0.8));
  for (Material& material : builder.thing().materials)
    material.stains = dirt;
  const int variant = variantFor(request, 4, random);
  const double height =
      random.pick(std::vector<double>{0.3, 0.45, 0.5, 0.7, 0.75, 0.9});
  const double base = height * random.uniform(0.24, 0.3); // half the foot's side
  const double plate = 0.035 * height + 0.008;
  const bool round_foot = variant == 3, black_foot = variant == 1 || random.chance(0.3);
  std::vector<Ring> rings = {ringAt(0, 0, 0),
                             ringAt(0, base, base, 0.15, true),
                             ringAt(plate, base * 0.96, base * 0.96, 0.15, true),
                             ringAt(plate, 0, 0)};
  if (round_foot)
    for (Ring& ring : rings)
      ring.roundness = 1;
  for (Ring& ring : rings)
    ring.material = black_foot ? foot : body;
  builder.add(loftMesh(rings, 32));
  // the cone, its skirt wider; a delineator is nearly a cylinder
  const double wide = variant == 2 ? 0.1 * height : base * 0.78;
  const double tip = variant == 2 ? 0.075 * height : random.uniform(0.02, 0.03);
  const int bands = variant == 1 ? 1 : 1 + random.index(3);
  std::vector<Ring> cone;
  const auto radiusAt = [&](double share) { return wide + (tip - wide) * share; };
  const auto add = [&](double share, int material) {
    Ring ring =
        ringAt(plate + (height - plate) * share, radiusAt(share), radiusAt(share));
    ring.material = material;
    cone.push_back(ring);
  };
  add(0, body);
  for (int i = 0; i < bands; ++i) {
    const double from = 0.32 + 0.55 * i / bands;
    add(from, band);
    add(from + 0.55 / bands * 0.55, body);
  }
  add(1, body);
  cone.back().crease = true;
  cone.push_back(ringAt(height, tip * 0.7, tip * 0.7, 1, true));
  cone.push_back(ringAt(height - 0.06, tip * 0.6, tip * 0.6));
  builder.add(loftMesh(cone, 36));
  builder.thing().substance = "plastic";
  builder.thing().density = 60;
  return builder.finish();
}

Thing
makeHat(const ThingRequest& request, Random& random)
{
  ThingBuilder builder(request);
  static const std::vector<Rgb> colors = {{{236, 200, 36}},
                                          {{238, 238, 234}},
                                          {{220, 96, 30}},
                                          {{196, 40, 36}},
                                          {{40, 90, 170}},
                                          {{50, 140, 70}}};
  const int shell = builder.addMaterial(
      plainMaterial(pickColor(request, colors, random), random, 0.35));
  const int inside = builder.addMaterial(plainMaterial({{50, 50, 52}}, random, 0.0));
  builder.thing().materials[0].stains = request.wear.value_or(random.uniform(0, 0.6));
  const int variant = variantFor(request, 4, random);
  const double a = random.uniform(0.122, 0.136), b = a * random.uniform(0.78, 0.86);
  const double height = random.uniform(0.125, 0.155);
  const double brim = variant == 1 ? 0.04 : 0.012; // full brim, or a rim and a peak
  const double peak = variant == 1 ? 0.01 : random.uniform(0.02, 0.045);
  std::vector<Ring> rings;
  const auto dome = [&](double scale, bool inner) {
    std::vector<Ring> profile;
    for (int i = 0; i <= 9; ++i) {
      const double turn = 0.25 * i / 9;
      // fuller than an ellipsoid
      const double r =
          i == 9 ? 0 : std::sqrt(std::sqrt(cosineOfTurns(turn)) * cosineOfTurns(turn));
      Ring ring = ringAt(
          0.015 + scale * height * sineOfTurns(turn), scale * a * r, scale * b * r);
      ring.material = inner ? inside : shell;
      profile.push_back(ring);
    }
    return profile;
  };
  Ring under = ringAt(0.012, 0.96 * a, 0.96 * b);
  Ring rim = ringAt(0.0, a + brim + peak / 2, b + brim, 1, true);
  rim.shift_x = peak / 2;
  Ring edge = rim;
  edge.z = 0.004;
  rings.push_back(under);
  rings.push_back(rim);
  rings.push_back(edge);
  const std::vector<Ring> outer = dome(1, false);
  rings.insert(rings.end(), outer.begin(), outer.end());
  builder.add(loftMesh(rings, 40));
  std::vector<Ring> inner = dome(0.96, true);
  std::reverse(inner.begin(), inner.end());
  builder.add(loftMesh(inner, 32));
  const int ridges = variant == 0 ? 1 : variant == 3 ? 0 : 3;
  for (int k = 0; k < ridges; ++k) {
    const double off = ridges == 1 ? 0 : (k - 1) * 0.035;
    std::vector<Vector3d> path;
    for (int i = 1; i <= 11; ++i) {
      const double t = 0.5 * i / 12; // half a circle from front to back
      const double x = a * cosineOfTurns(t);
      const double flat = std::sqrt(std::max(0.0, 1 - off * off / (b * b)));
      path.emplace_back(x * flat * 0.98, off, 0.017 + height * sineOfTurns(t) * flat);
    }
    builder.add(tubeMesh(path, {ridges == 1 ? 0.014 : 0.008}, 10, shell));
  }
  if (variant == 2) // chin strap on the outside
    builder.add(tubeMesh({{0, b, 0.01},
                          {0.03, b + 0.02, 0.0},
                          {0.09, 0.06, 0.0},
                          {0.09, -0.06, 0.0},
                          {0.03, -b - 0.02, 0.0},
                          {0, -b, 0.01}},
                         {0.004},
                         6,
                         inside));
  builder.thing().substance = "plastic";
  builder.thing().density = 70;
  return builder.finish();
}

Thing
makeGloves(const ThingRequest& request, Random& random)
{
  ThingBuilder builder(request);
  static const std::vector<Rgb> colors = {{{214, 120, 40}},
                                          {{60, 90, 150}},
                                          {{190, 190, 180}},
                                          {{60, 60, 64}},
                                          {{200, 205, 60}},
                                          {{150, 100, 60}}};
  Material cloth = plainMaterial(pickColor(request, colors, random), random, 0.02);
  cloth.texture = Texture::fabric;
  cloth.stains = request.wear.value_or(random.uniform(0, 0.9));
  const int palm = builder.addMaterial(cloth);
  cloth.color = variedColor(random.pick(colors), 16, random);
  const int cuff = builder.addMaterial(cloth);
  const int variant = variantFor(request, 3, random);
  const int count = variant == 1 ? 1 : 2;
  for (int g = 0; g < count; ++g) {
    Mesh glove;
    const double side = g == 0 ? 1 : -1; // right and left hand
    const double puff = random.uniform(0.013, 0.022);
    glove.append(ellipsoidMesh({0.055, 0.05, puff}, 16, palm),
                 Eigen::Affine3d(Eigen::Translation3d(0, 0, puff)));
    for (int f = 0; f < 4; ++f) {
      const double y = (f - 1.5) * 0.024;
      const double spread = (f - 1.5) * random.uniform(0.004, 0.02);
      const double length = (f == 1 || f == 2 ? 0.085
                             : f == 0         ? 0.075
                                              : 0.06) *
                            random.uniform(0.9, 1.05);
      const double lift = random.uniform(0, 0.03);
      glove.append(
          tubeMesh({{0.035, y, puff},
                    {0.035 + 0.55 * length, y + spread / 2, puff + lift},
                    {0.035 + length, y + spread, puff * 0.7 + lift * 0.5},
                    {0.043 + length, y + spread * 1.1, puff * 0.6 + lift * 0.4}},
                   {0.0125, 0.012, 0.011, 0.006},
                   10,
                   random.chance(0.15) ? cuff : palm),
          Eigen::Affine3d::Identity());
    }
    glove.append(tubeMesh({{-0.02, side * 0.035, puff},
                           {0.02, side * 0.07, puff * 1.2},
                           {0.05, side * 0.083, puff},
                           {0.057, side * 0.086, puff * 0.9}},
                          {0.016, 0.0135, 0.011, 0.006},
                          10,
                          palm),
                 Eigen::Affine3d::Identity());
    const double length = random.uniform(0.05, 0.11);
    glove.append(
        tubeMesh({{-0.045, 0, puff}, {-0.06, 0, puff}, {-0.05 - length, 0, puff * 1.1}},
                 {0.036, 0.04, 0.047},
                 18,
                 cuff),
        Eigen::Affine3d(Eigen::Scaling(1.0, 1.0, 0.55)) *
            Eigen::Translation3d(0, 0, puff * 0.6));
    Eigen::Affine3d place = Eigen::Affine3d::Identity();
    if (count == 2) {
      const double turn = random.uniform(-0.08, 0.08);
      Eigen::Matrix3d r;
      r << cosineOfTurns(turn), -sineOfTurns(turn), 0, sineOfTurns(turn),
          cosineOfTurns(turn), 0, 0, 0, 1;
      place.linear() = r;
      // side by side, or one on the other
      place.translation() =
          variant == 2 && g == 1
              ? Vector3d(random.uniform(-0.03, 0.03), 0, 0.03)
              : Vector3d(random.uniform(-0.02, 0.02), -side * 0.075, 0);
    }
    builder.add(glove, place);
  }
  builder.thing().substance = "fabric";
  builder.thing().density = 120;
  return builder.finish();
}

Thing
makeWorksiteThing(const ThingRequest& request, Random& random)
{
  Thing thing = request.kind == "safety cone"     ? makeCone(request, random)
                : request.kind == "hard hat"      ? makeHat(request, random)
                : request.kind == "safety gloves" ? makeGloves(request, random)
                : request.kind == "gas container" ? makeGasContainer(request, random)
                : request.kind == "chair"         ? makeChair(request, random)
                : request.kind == "plant"         ? makePlant(request, random)
                                                  : makeContainer(request, random);
  thing.annotated = true;
  return thing;
}

} // namespace simulation
} // namespace hoist
