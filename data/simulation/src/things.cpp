#include <hoist/simulation/things.h>

#include "thing_builder.h"

#include <algorithm>

namespace hoist {
namespace simulation {
namespace {

// annotated, cuboid, on timbers, tips, stackable
const std::vector<KindTraits> kinds = {
    {"slab", true, true, true, false, true},
    {"column", true, true, true, false, true},
    {"beam", true, true, true, false, true},
    {"block", true, true, true, true, true},
    {"bricks", true, true, false, false, false},
    {"carton", true, true, false, true, true},
    {"crate", true, true, false, true, true},
    {"timber", true, true, false, false, true},
    {"box", true, true, false, true, true},
    {"pallet", true, false, false, false, false},
    {"safety cone", true, false, false, true, true},
    {"hard hat", true, false, false, true, true},
    {"bucket", true, false, false, true, true},
    {"recycle bin", true, false, false, true, false},
    {"safety gloves", true, false, false, false, true},
    {"gas container", true, false, false, true, true},
    {"chair", true, false, false, true, false},
    {"plant", true, false, false, false, true},
    {"pipe", false, false, false, false, true},
    {"drum", false, false, false, true, false},
    {"can", false, false, false, true, true},
    {"rubble", false, false, false, false, false},
    {"sawhorse", false, false, false, false, false},
    {"scaffold", false, false, false, false, false},
    {"worker", false, false, false, false, false},
    {"post", false, false, false, false, false},
};

constexpr std::size_t first_class = 10, first_clutter = 18;

} // namespace

const std::vector<KindTraits>&
thingKinds()
{
  return kinds;
}

const KindTraits*
findKind(const std::string& kind)
{
  const auto found = std::find_if(
      kinds.begin(), kinds.end(), [&](const KindTraits& k) { return k.kind == kind; });
  return found == kinds.end() ? nullptr : &*found;
}

Thing
makeThing(const ThingRequest& request, Random& random)
{
  const auto found = static_cast<std::size_t>(findKind(request.kind) - kinds.data());
  if (found >= first_clutter)
    return makeClutter(request, random);
  if (found >= first_class)
    return makeWorksiteThing(request, random);
  return makeElement(request, random);
}

} // namespace simulation
} // namespace hoist
