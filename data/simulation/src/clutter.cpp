// Things that are not looked for: they hide what is, and must not be taken for it.
#include "thing_builder.h"

namespace hoist {
namespace simulation {
namespace {

using Eigen::Vector3d;

void
makeRound(ThingBuilder& builder,
          double radius,
          double height,
          bool ribs,
          Random& random)
{
  std::vector<Ring> rings;
  const auto add = [&](double z, double r, bool crease) {
    Ring ring;
    ring.z = z;
    ring.half_x = ring.half_y = r;
    ring.crease = crease;
    rings.push_back(ring);
  };
  add(0, 0, false);
  add(0, radius, true);
  if (ribs)
    for (const double share : {0.33, 0.66}) {
      add(height * share - 0.02, radius, false);
      add(height * share, radius * 1.03, false);
      add(height * share + 0.02, radius, false);
    }
  add(height, radius, true);
  add(height, radius * 0.95, true);
  add(height - 0.02 * height, radius * 0.94, true);
  add(height - 0.02 * height, 0, false);
  builder.add(loftMesh(rings, 40));
  builder.addMaterial(plainMaterial(
      variedColor(
          random.pick(std::vector<Rgb>{
              {{40, 80, 140}}, {{150, 50, 40}}, {{60, 110, 70}}, {{190, 190, 185}}}),
          15,
          random),
      random,
      0.3));
  builder.thing().materials.front().texture =
      ribs && random.chance(0.6) ? Texture::rust : Texture::plain;
  builder.thing().materials.front().second = {{110, 62, 38}};
}

void
makePipe(ThingBuilder& builder, Random& random)
{
  const double length = random.uniform(0.8, 3), radius = random.uniform(0.02, 0.12);
  Mesh tube =
      tubeMesh({{-length / 2, 0, radius}, {length / 2, 0, radius}}, {radius}, 24);
  builder.add(tube);
  Material material = plainMaterial(
      random.pick(std::vector<Rgb>{{{190, 95, 40}}, {{120, 122, 125}}, {{40, 42, 46}}}),
      random,
      0.3);
  material.texture = random.chance(0.4) ? Texture::rust : Texture::plain;
  material.second = {{112, 62, 38}};
  builder.addMaterial(material);
}

void
makeRubble(ThingBuilder& builder, Random& random)
{
  Material material = plainMaterial({{150, 145, 138}}, random, 0);
  material.texture = Texture::concrete;
  builder.addMaterial(material);
  const int stones = 12 + random.index(20);
  const double spread = random.uniform(0.3, 0.8);
  for (int i = 0; i < stones; ++i) {
    const double size = random.uniform(0.03, 0.16);
    const Mesh stone = stoneMesh({size * random.uniform(0.5, 1),
                                  size * random.uniform(0.5, 1),
                                  size * random.uniform(0.3, 0.7)},
                                 0,
                                 random);
    const double r = spread * std::sqrt(random.uniform());
    Vector3d place = circlePoint(random.uniform(), r, 0);
    place.z() = size * 0.3 + 0.25 * (1 - r / spread) * random.uniform();
    builder.add(stone, place);
  }
}

void
makeSawhorse(ThingBuilder& builder, Random& random)
{
  Material material = plainMaterial({{180, 138, 90}}, random, 0);
  material.texture = Texture::wood;
  builder.addMaterial(material);
  const double height = random.uniform(0.6, 0.85), length = random.uniform(0.8, 1.3);
  builder.add(boxMesh({length, 0.09, 0.06}), Vector3d(0, 0, height - 0.03));
  for (const double end : {-0.42, 0.42})
    for (const double side : {-0.28, 0.28})
      builder.add(tubeMesh(
          {{end * length, side, 0}, {end * length, 0, height - 0.05}}, {0.035}, 4));
}

void
makeScaffold(ThingBuilder& builder, Random& random)
{
  builder.addMaterial(plainMaterial({{150, 154, 158}}, random, 0.4));
  builder.thing().materials.front().metal = true;
  Material wood = plainMaterial({{170, 132, 90}}, random, 0);
  wood.texture = Texture::wood;
  builder.addMaterial(wood);
  const double length = random.uniform(2, 3), depth = 0.75, storey = 2;
  const int storeys = 1 + random.index(2);
  const double top = storeys * storey + 1;
  const auto bar = [&](const Vector3d& a, const Vector3d& b) {
    builder.add(tubeMesh({a, b}, {0.024}, 10));
  };
  for (const double x : {-length / 2, length / 2})
    for (const double y : {-depth / 2, depth / 2})
      bar({x, y, 0}, {x, y, top});
  for (int s = 1; s <= storeys; ++s) {
    const double z = s * storey;
    for (const double y : {-depth / 2, depth / 2}) {
      bar({-length / 2, y, z - 0.05}, {length / 2, y, z - 0.05});
      bar({-length / 2, y, z + 0.9}, {length / 2, y, z + 0.9});
    }
    for (const double x : {-length / 2, length / 2})
      bar({x, -depth / 2, z - 0.05}, {x, depth / 2, z - 0.05});
    bar({-length / 2, depth / 2, z - storey}, {length / 2, depth / 2, z});
    builder.add(boxMesh({length, depth - 0.06, 0.04}, {}, 1), Vector3d(0, 0, z));
  }
}

// A person in work clothes, made of rounded limbs: a silhouette, no portrait.
void
makeWorker(ThingBuilder& builder, Random& random)
{
  const int skin = builder.addMaterial(
      plainMaterial(random.pick(std::vector<Rgb>{
                        {{214, 168, 140}}, {{160, 112, 84}}, {{96, 66, 50}}}),
                    random,
                    0));
  const int vest = builder.addMaterial(
      plainMaterial(random.pick(std::vector<Rgb>{
                        {{226, 232, 40}}, {{240, 110, 30}}, {{60, 80, 120}}}),
                    random,
                    0));
  const int band = builder.addMaterial(plainMaterial({{205, 208, 205}}, random, 0.3));
  const int trousers = builder.addMaterial(plainMaterial(
      random.pick(std::vector<Rgb>{{{40, 46, 62}}, {{90, 84, 70}}, {{30, 30, 32}}}),
      random,
      0));
  const int hat = builder.addMaterial(
      plainMaterial(random.pick(std::vector<Rgb>{
                        {{240, 200, 30}}, {{235, 235, 230}}, {{200, 40, 30}}}),
                    random,
                    0.3));
  const double s = random.uniform(0.92, 1.08);
  const bool bent = random.chance(0.35);
  const double lean = bent ? random.uniform(0.15, 0.4) : random.uniform(0, 0.05);
  const double step = random.uniform(0.03, 0.28);
  const Vector3d hip(0, 0, 0.92 * s), neck(lean, 0, (bent ? 1.38 : 1.46) * s);
  const Vector3d head = neck + Vector3d(0.04 + lean * 0.25, 0, 0.15 * s);
  for (const double side : {-1.0, 1.0}) {
    const Vector3d foot(side * step, side * 0.12, 0.06);
    const Vector3d knee(0.5 * side * step + 0.05, side * 0.11, 0.5 * s);
    builder.add(tubeMesh({hip + Vector3d(0, side * 0.09, 0), knee, foot},
                         {0.1, 0.075, 0.06},
                         12,
                         trousers));
    builder.add(ellipsoidMesh({0.13, 0.05, 0.06}, 10, trousers),
                Vector3d(foot.x() + 0.06, foot.y(), 0.06));
    const double swing = random.uniform(-0.2, 0.4);
    const Vector3d shoulder = neck + Vector3d(0, side * 0.2, -0.06);
    const Vector3d elbow = shoulder + Vector3d(0.5 * swing, side * 0.07, -0.28 * s);
    const Vector3d hand = elbow + Vector3d(swing + 0.05, -side * 0.03, -0.22 * s);
    builder.add(tubeMesh({shoulder, elbow, hand}, {0.062, 0.05, 0.04}, 10, vest));
    builder.add(ellipsoidMesh({0.05, 0.035, 0.06}, 10, skin), hand);
  }
  std::vector<Vector3d> spine;
  std::vector<double> width;
  for (int i = 0; i <= 8; ++i) {
    const double t = i / 8.0;
    spine.emplace_back(hip + (neck - hip) * t);
    width.push_back(0.155 + 0.035 * t - (i == 8 ? 0.09 : 0));
  }
  Mesh torso = tubeMesh(spine, width, 16, vest);
  for (std::size_t i = 0; i < torso.triangles.size(); ++i)
    if (i / 32 == 2 || i / 32 == 4) // reflecting bands around the vest
      torso.triangles[i].material = static_cast<std::uint16_t>(band);
  builder.add(torso, Eigen::Affine3d(Eigen::Scaling(1.0, 1.25, 1.0)));
  builder.add(tubeMesh({neck, head}, {0.06}, 10, skin));
  builder.add(ellipsoidMesh({0.1, 0.08, 0.125}, 14, skin), head);
  builder.add(ellipsoidMesh({0.135, 0.115, 0.11}, 16, hat),
              Vector3d(head + Vector3d(0.01, 0, 0.06)));
}

} // namespace

Thing
makeClutter(const ThingRequest& request, Random& random)
{
  ThingBuilder builder(request);
  if (request.kind == "pipe")
    makePipe(builder, random);
  else if (request.kind == "drum")
    makeRound(
        builder, random.uniform(0.27, 0.3), random.uniform(0.8, 0.9), true, random);
  else if (request.kind == "can")
    makeRound(
        builder, random.uniform(0.03, 0.08), random.uniform(0.08, 0.24), false, random);
  else if (request.kind == "rubble")
    makeRubble(builder, random);
  else if (request.kind == "sawhorse")
    makeSawhorse(builder, random);
  else if (request.kind == "scaffold")
    makeScaffold(builder, random);
  else if (request.kind == "worker")
    makeWorker(builder, random);
  else { // a post that hides a part
    const double radius = random.uniform(0.02, 0.06);
    builder.addMaterial(plainMaterial({{130, 132, 135}}, random, 0.2));
    builder.add(tubeMesh({{0, 0, 0}, {0, 0, random.uniform(1.2, 2.6)}}, {radius}, 14));
  }
  if (request.color)
    builder.thing().materials.front().color = *request.color;
  return builder.finish();
}

} // namespace simulation
} // namespace hoist
