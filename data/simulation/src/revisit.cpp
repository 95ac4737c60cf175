#include "site.h"

#include <algorithm>

namespace hoist {
namespace simulation {

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
      ++gone_;
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
