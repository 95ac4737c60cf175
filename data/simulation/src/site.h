#pragma once

#include "footprint.h"

#include <hoist/simulation/description.h>

namespace hoist {
namespace simulation {

/** \brief Places things so that none runs through another. */
class Site {
public:
  Site(const Description& description, std::uint64_t seed);

  /** \brief What happens between two visits: some things go, some move, some come. */
  void revisit(int visit);

  /** \brief Whether a camera can stand there: not in a thing, nor closer than 0.3 m. */
  bool free(const Eigen::Vector3d& eye) const;

  /** \brief The scene without light and camera. */
  const Scene&
  scene() const
  {
    return scene_;
  }

private:
  struct Placed {
    std::size_t thing;
    Footprint footprint;
    double bottom, top;   ///< [m]
    bool carries = false; ///< something stands on it
    int group;            ///< of the description
  };

  void addGround();
  void addWalls();
  void addTable();
  void addGroup(int group, int count, const char* status);
  bool place(Thing& thing, const ThingGroup& group, Placed& placed);
  bool tryPlace(Thing& thing, const ThingGroup& group, Placed& placed);
  bool onTop(Footprint& footprint, const KindTraits& traits, Placed& placed);
  bool against(Footprint& footprint, double& heading, Placed& placed);
  void layTimbers(const Footprint& load, const Placed& placed);
  bool collides(const Footprint& footprint, double bottom, double top) const;
  Thing make(const ThingGroup& group);
  std::string nextNumber() const;
  void commit(Thing thing, Placed placed);

  const Description& description_;
  Random random_;
  Eigen::Vector2d area_; ///< sides of the rectangle for things [m]
  Scene scene_;
  std::vector<Placed> placed_;
  int next_label_ = 1;
  std::size_t gone_ = 0; ///< things removed so far: numbers in names are not used again
  int carrier_ = -1;     ///< index in placed_ of what the thing being placed stands on
};

} // namespace simulation
} // namespace hoist
