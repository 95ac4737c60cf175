#include "site.h"

#include <algorithm>
#include <cmath>

namespace hoist {
namespace simulation {
namespace {

constexpr double degree = 1.0 / 360; // [turns]

// A quarter, a half or three quarters about x or y: onto a side or upside down.
Eigen::Matrix3d
tippedOver(Random& random)
{
  Eigen::Matrix3d r;
  switch (random.index(4)) {
  case 0:
    r << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    break;
  case 1:
    r << 0, 0, 1, 0, 1, 0, -1, 0, 0;
    break;
  case 2:
    r << 0, 0, -1, 0, 1, 0, 1, 0, 0;
    break;
  default:
    r << 1, 0, 0, 0, -1, 0, 0, 0, -1;
    break;
  }
  return r;
}

Eigen::AlignedBox3d
turnedBounds(const Mesh& mesh, const Eigen::Matrix3d& turn)
{
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    box.extend(turn * vertex);
  return box;
}

} // namespace

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
    const Range& count = description_.things[g].count;
    // a whole number, each as likely
    const int n =
        static_cast<int>(std::floor(random_.uniform(count.low, count.high + 1)));
    addGroup(static_cast<int>(g), std::min(n, static_cast<int>(count.high)), nullptr);
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
  const Range& count = *description_.walls;
  const int n = std::min(
      4, static_cast<int>(std::floor(random_.uniform(count.low, count.high + 1))));
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
  Thing table;
  table.kind = table.name = "table";
  Material material;
  static const std::vector<Rgb> tops = {
      {{182, 146, 104}}, {{200, 198, 192}}, {{120, 86, 58}}, {{90, 92, 96}}};
  material.color = random_.pick(tops);
  material.texture = random_.chance(0.5) ? Texture::wood : Texture::plain;
  material.gloss = random_.uniform(0, 0.25);
  material.contrast = 0.5;
  material.seed = random_.bits();
  table.materials.push_back(material);
  Mesh mesh = boxMesh({sides.x(), sides.y(), 0.03});
  const Eigen::Vector3d leg(0.05, 0.05, sides.z() - 0.03);
  for (int k = 0; k < 4; ++k)
    mesh.append(
        boxMesh(leg),
        Eigen::Affine3d(Eigen::Translation3d((k & 1 ? 0.5 : -0.5) * (sides.x() - 0.12),
                                             (k & 2 ? 0.5 : -0.5) * (sides.y() - 0.12),
                                             -0.015 - leg.z() / 2)));
  for (Mesh::Triangle& triangle : mesh.triangles)
    triangle.face = Mesh::no_face;
  table.mesh = std::make_shared<const Mesh>(std::move(mesh));
  table.box_size = sides;
  table.pose.translation().z() = sides.z() - 0.015;
  scene_.things.push_back(table);
  scene_.support_height = sides.z();
  area_ = sides.head<2>();
}

Thing
Site::make(const ThingGroup& group)
{
  ThingRequest request;
  request.kind = random_.pick(group.kinds);
  if (group.size)
    request.size = Eigen::Vector3d((*group.size)[0].draw(random_),
                                   (*group.size)[1].draw(random_),
                                   (*group.size)[2].draw(random_));
  if (!group.colors.empty())
    request.color = random_.pick(group.colors);
  if (!group.textures.empty())
    request.texture = random_.pick(group.textures);
  if (group.wear)
    request.wear = group.wear->draw(random_);
  request.full = random_.chance(group.full);
  request.mesh = group.mesh;
  request.split = group.split;
  // a generator of its own: a part more of one thing does not move the next
  Random own(random_.bits());
  Thing thing = makeThing(request, own);
  thing.kind = request.kind;
  return thing;
}

void
Site::addGroup(int number, int count, const char* status)
{
  const ThingGroup& group = description_.things[static_cast<std::size_t>(number)];
  for (int k = 0; k < count; ++k) {
    Thing thing = make(group);
    const int own = static_cast<int>(scene_.things.size());
    thing.name = group.name.empty() || k > 0 ? thing.kind + "-" + std::to_string(own)
                                             : group.name;
    if (status != nullptr && thing.annotated)
      thing.status = ObjectStatus::added;
    Placed placed{};
    placed.group = number;
    if (place(thing, group, placed))
      commit(std::move(thing), placed);
  }
}

void
Site::commit(Thing thing, Placed placed)
{
  if (thing.annotated && thing.label == 0)
    thing.label = next_label_++;
  if (carrier_ >= 0) {
    placed_[static_cast<std::size_t>(carrier_)].carries = true;
    thing.supported_by =
        scene_.things[placed_[static_cast<std::size_t>(carrier_)].thing].name;
  }
  placed.thing = scene_.things.size();
  scene_.things.push_back(std::move(thing));
  placed_.push_back(placed);
}

bool
Site::collides(const Footprint& footprint, double bottom, double top) const
{
  return std::any_of(placed_.begin(), placed_.end(), [&](const Placed& other) {
    return bottom < other.top - 1e-9 && other.bottom < top - 1e-9 &&
           meet(footprint, other.footprint, 1e-4);
  });
}

bool
Site::onTop(Footprint& footprint, const KindTraits& traits, Placed& placed)
{
  if (!traits.stackable)
    return false;
  std::vector<int> carriers;
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    const KindTraits* below = findKind(scene_.things[placed_[i].thing].kind);
    if (below != nullptr && below->cuboid && !placed_[i].carries &&
        scene_.things[placed_[i].thing].is_cuboid &&
        0.8 * footprint.half.x() <= placed_[i].footprint.half.x() &&
        0.8 * footprint.half.y() <= placed_[i].footprint.half.y() &&
        placed_[i].top < 2.2 + scene_.support_height)
      carriers.push_back(static_cast<int>(i));
  }
  if (carriers.empty())
    return false;
  carrier_ = random_.pick(carriers);
  const Placed& below = placed_[static_cast<std::size_t>(carrier_)];
  const Eigen::Vector2d room =
      (below.footprint.half - 0.75 * footprint.half).cwiseMax(0.0);
  const double turn = random_.uniform(-6, 6) * degree;
  const Eigen::Vector2d axis = below.footprint.axis;
  footprint.center = below.footprint.center +
                     axis * (room.x() * random_.uniform(-1, 1)) +
                     below.footprint.side() * (room.y() * random_.uniform(-1, 1));
  const double c = cosineOfTurns(turn), s = sineOfTurns(turn);
  footprint.axis = {c * axis.x() - s * axis.y(), s * axis.x() + c * axis.y()};
  placed.bottom = below.top;
  return true;
}

bool
Site::against(Footprint& footprint, double& heading, Placed& placed)
{
  std::vector<int> neighbours;
  for (std::size_t i = 0; i < placed_.size(); ++i)
    if (scene_.things[placed_[i].thing].is_cuboid && placed_[i].bottom == placed.bottom)
      neighbours.push_back(static_cast<int>(i));
  if (neighbours.empty())
    return false;
  const Footprint& other =
      placed_[static_cast<std::size_t>(random_.pick(neighbours))].footprint;
  footprint.axis = other.axis;
  const double gap = random_.chance(0.5) ? 0.0002 : random_.uniform(0.001, 0.012);
  const double sign = random_.chance(0.5) ? 1 : -1;
  const bool along = random_.chance(0.5);
  const Eigen::Vector2d out = along ? other.axis : other.side();
  const Eigen::Vector2d slide = along ? other.side() : other.axis;
  const double off = other.reach(out) + footprint.reach(out) + gap;
  footprint.center =
      other.center + out * (sign * off) +
      slide * ((other.reach(slide) - footprint.reach(slide)) * random_.uniform(-1, 1));
  heading = 0; // the axis tells
  return true;
}

bool
Site::place(Thing& thing, const ThingGroup& group, Placed& placed)
{
  for (int attempt = 0; attempt < 60; ++attempt) {
    carrier_ = -1;
    if (tryPlace(thing, group, placed))
      return true;
  }
  carrier_ = -1;
  return false;
}

bool
Site::tryPlace(Thing& thing, const ThingGroup& group, Placed& placed)
{
  const KindTraits& traits = *findKind(thing.kind);
  const bool tip = traits.tips && random_.chance(group.tipped);
  const Eigen::Matrix3d tipped =
      tip ? tippedOver(random_) : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  const Eigen::AlignedBox3d bounds = turnedBounds(*thing.mesh, tipped);
  Footprint footprint;
  footprint.half = bounds.sizes().head<2>() / 2;
  double heading =
      group.heading ? group.heading->draw(random_) * degree : random_.uniform();
  footprint.axis = {cosineOfTurns(heading), sineOfTurns(heading)};
  placed.bottom = scene_.support_height;
  bool with_timbers = false;
  if (group.at) {
    footprint.center = {(*group.at)[0].draw(random_), (*group.at)[1].draw(random_)};
  }
  else if (!(group.stacked > 0 && random_.chance(group.stacked) &&
             onTop(footprint, traits, placed)) &&
           !(group.touching > 0 && random_.chance(group.touching) &&
             against(footprint, heading, placed))) {
    Footprint area;
    area.half = area_ / 2;
    footprint.center = {area.half.x() * random_.uniform(-1, 1),
                        area.half.y() * random_.uniform(-1, 1)};
    if (!within(footprint, area) && random_.chance(0.9))
      return false;
    with_timbers = traits.on_timbers && random_.chance(group.timbers);
  }
  if (group.lift)
    placed.bottom += group.lift->draw(random_);
  const double timber = with_timbers ? 0.1 : 0;
  placed.footprint = footprint;
  placed.top = placed.bottom + timber + bounds.sizes().z();
  if (!group.lift && collides(footprint, placed.bottom, placed.top))
    return false;
  if (with_timbers) {
    layTimbers(footprint, placed);
    placed.bottom += timber;
  }
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.col(0).head<2>() = footprint.axis;
  turn.col(1).head<2>() = footprint.side();
  const Eigen::Vector3d middle(
      bounds.center().x(), bounds.center().y(), bounds.min().z());
  thing.pose.linear() = turn * tipped;
  thing.pose.translation() =
      Eigen::Vector3d(footprint.center.x(), footprint.center.y(), placed.bottom) -
      turn * middle;
  return true;
}

void
Site::layTimbers(const Footprint& load, const Placed& placed)
{
  const bool along = load.half.x() >= load.half.y();
  const double length =
      2 * (along ? load.half.y() : load.half.x()) - random_.uniform(0, 0.1);
  const double reach = (along ? load.half.x() : load.half.y()) - 0.12;
  const Eigen::Vector2d way = along ? load.axis : load.side();
  for (const double where : {-0.6, 0.6}) {
    ThingRequest request;
    request.kind = "timber";
    request.size = Eigen::Vector3d(length, 0.1, 0.1);
    Random own(random_.bits());
    Thing timber = makeThing(request, own);
    timber.kind = request.kind;
    timber.name = "timber-" + std::to_string(scene_.things.size());
    Placed below{};
    below.group = placed.group;
    below.footprint.center = load.center + way * (reach * where);
    below.footprint.axis = along ? load.side() : load.axis;
    below.footprint.half = {length / 2, 0.05};
    below.bottom = placed.bottom;
    below.top = placed.bottom + 0.1;
    below.carries = true;
    timber.pose.linear().col(0).head<2>() = below.footprint.axis;
    timber.pose.linear().col(1).head<2>() = below.footprint.side();
    timber.pose.translation() = Eigen::Vector3d(
        below.footprint.center.x(), below.footprint.center.y(), below.bottom);
    commit(std::move(timber), below);
  }
}

bool
Site::free(const Eigen::Vector3d& eye) const
{
  Footprint here;
  here.center = eye.head<2>();
  here.half = {0.3, 0.3};
  return !collides(here, eye.z() - 0.3, eye.z() + 0.3);
}

void
Site::revisit(int visit)
{
  random_ = Random(subSeed(scene_.seed, "visit", static_cast<std::uint64_t>(visit)));
  scene_.removed.clear();
  for (Thing& thing : scene_.things) {
    thing.previous.reset();
    thing.status.reset();
    if (thing.annotated)
      thing.status = ObjectStatus::unchanged;
  }
  const std::vector<Placed> before = placed_;
  std::vector<Thing> things;
  std::vector<std::size_t> moved;
  std::vector<bool> gone(scene_.things.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    Thing& thing = scene_.things[before[i].thing];
    if (before[i].carries || thing.minor || !thing.annotated)
      continue;
    const double fate = random_.uniform();
    if (fate < description_.gone) {
      thing.status = ObjectStatus::removed;
      scene_.removed.push_back(thing);
      gone[before[i].thing] = true;
    }
    else if (fate < description_.gone + description_.moved)
      moved.push_back(before[i].thing);
  }
  for (const std::size_t index : moved) {
    // its own place is free while another is looked for
    const auto own = std::find_if(placed_.begin(), placed_.end(), [&](const Placed& p) {
      return p.thing == index;
    });
    const Placed old = *own;
    placed_.erase(own);
    Thing& thing = scene_.things[index];
    ThingGroup group = description_.things[static_cast<std::size_t>(old.group)];
    group.at.reset();
    group.stacked = group.timbers = 0;
    Placed now = old;
    const Eigen::Isometry3d pose = thing.pose;
    if (place(thing, group, now) &&
        (thing.pose.translation() - pose.translation()).norm() > 0.3) {
      thing.previous = pose;
      thing.status = ObjectStatus::moved;
      thing.supported_by.clear();
      placed_.push_back(now);
    }
    else {
      thing.pose = pose;
      placed_.push_back(old);
    }
  }
  std::vector<std::size_t> renumbered(scene_.things.size());
  for (std::size_t i = 0; i < scene_.things.size(); ++i) {
    renumbered[i] = things.size();
    if (!gone[i])
      things.push_back(scene_.things[i]);
  }
  scene_.things = std::move(things);
  placed_.erase(std::remove_if(placed_.begin(),
                               placed_.end(),
                               [&](const Placed& p) { return gone[p.thing]; }),
                placed_.end());
  for (Placed& one : placed_)
    one.thing = renumbered[one.thing];
  for (std::size_t g = 0; g < description_.things.size(); ++g) {
    const Range& count = description_.things[g].count;
    const double expected = description_.added * 0.5 * (count.low + count.high);
    const int n = static_cast<int>(std::floor(expected)) +
                  (random_.chance(expected - std::floor(expected)) ? 1 : 0);
    addGroup(static_cast<int>(g), n, "new");
  }
}

} // namespace simulation
} // namespace hoist
