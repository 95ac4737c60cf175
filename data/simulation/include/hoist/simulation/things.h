#pragma once

#include <hoist/simulation/random.h>
#include <hoist/simulation/scene.h>

#include <optional>
#include <string>
#include <vector>

namespace hoist {
namespace simulation {

/** \brief What is asked of a thing; what is not set is drawn. */
struct ThingRequest {
  std::string kind;                    ///< one of thingKinds()
  std::optional<Eigen::Vector3d> size; ///< full sides of its box [m]
  std::optional<Rgb> color;
  std::optional<Texture> texture;
  std::optional<bool> full;   ///< of a bucket or a recycle bin
  std::optional<double> wear; ///< 0 new .. 1 battered
  std::string mesh;           ///< a file with its shape; "" makes one
  bool from_library = false;  ///< a shape of the mesh library, if it has the kind
  std::string split; ///< "train", "test": which meshes of a library may serve; "" none
};

/** \brief How a kind behaves when things are placed. */
struct KindTraits {
  std::string kind;
  bool annotated = true;
  bool cuboid = false;     ///< others may stand on it
  bool on_timbers = false; ///< heavy: laid on timbers
  bool tips = false;       ///< may lie on its side or upside down
  bool stackable = true;   ///< may stand on others
};

/** \brief All kinds that can be made, the annotated ones first. */
const std::vector<KindTraits>& thingKinds();

/** \brief The kind of that name; nullptr if there is none. */
const KindTraits* findKind(const std::string& kind);

/** \brief Makes a thing that stands upright, the middle of its foot in the origin.
 *  \throws LoadError if its mesh cannot be used */
Thing makeThing(const ThingRequest& request, Random& random);

} // namespace simulation
} // namespace hoist
