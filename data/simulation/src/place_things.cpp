#include "site.h"

#include <algorithm>
#include <cmath>

namespace hoist {
namespace simulation {
namespace {

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
  request.from_library = group.library_share > 0 && random_.chance(group.library_share);
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
    // the description's name is that of the first at the first visit
    thing.name = group.name.empty() || k > 0 || status != nullptr
                     ? thing.kind + "-" + nextNumber()
                     : group.name;
    if (status != nullptr && thing.annotated)
      thing.status = ObjectStatus::added;
    Placed placed{};
    placed.group = number;
    if (place(thing, group, placed))
      commit(std::move(thing), placed);
  }
}

std::string
Site::nextNumber() const
{
  return std::to_string(scene_.things.size() + gone_);
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
    timber.name = "timber-" + nextNumber();
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

} // namespace simulation
} // namespace hoist
