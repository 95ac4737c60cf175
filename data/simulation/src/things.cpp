#include <hoist/simulation/things.h>

#include "thing_builder.h"
#include <hoist/simulation/mesh_library.h>

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

// A thing of the shape that a file has.
Thing
fromShape(const ThingRequest& request, const LoadedMesh& shape, Random& random)
{
  ThingBuilder builder(request);
  const double dirt = request.wear.value_or(random.uniform(0, 0.5));
  const std::uint64_t seed = random.bits();
  for (Material material : shape.materials) {
    material.stains = dirt;
    material.seed = seed;
    builder.addMaterial(material);
  }
  builder.add(shape.mesh);
  return builder.finish();
}

// One of the library, if it has the class in that split.
bool
fromLibrary(const ThingRequest& request, Random& random, Thing& thing)
{
  std::vector<const LibraryMesh*> fitting;
  for (const LibraryMesh& mesh : meshLibrary())
    if (mesh.kind == request.kind &&
        (request.split.empty() || mesh.test == (request.split == "test")))
      fitting.push_back(&mesh);
  if (fitting.empty())
    return false;
  const LibraryMesh& chosen = *random.pick(fitting);
  const std::shared_ptr<const LoadedMesh> shape = libraryShape(chosen);
  thing = fromShape(request, *shape, random);
  // a plant is organic, whatever its pot is
  const std::string said =
      request.kind == "plant" ? std::string() : substanceOfMost(*shape);
  thing.substance = said.empty() ? chosen.substance : said;
  thing.mesh_file = chosen.archive + ":" + chosen.model;
  thing.density = 60;
  if (request.kind == "recycle bin")
    thing.full = false; // as the catalogue has them
  return true;
}

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
  // the list has lifting elements first, then the eight classes, then clutter
  const KindTraits* found = findKind(request.kind);
  Thing thing;
  if (!request.mesh.empty()) {
    thing = fromShape(request, loadMesh(request.mesh), random);
    thing.mesh_file = request.mesh;
    thing.annotated = found->annotated;
    return thing;
  }
  if (request.from_library && fromLibrary(request, random, thing)) {
    thing.annotated = true;
    return thing;
  }
  if (found >= findKind("pipe"))
    return makeClutter(request, random);
  if (found >= findKind("safety cone"))
    return makeWorksiteThing(request, random);
  return makeElement(request, random);
}

} // namespace simulation
} // namespace hoist
