#pragma once

#include <hoist/simulation/things.h>

#include <vector>

namespace hoist {
namespace simulation {

/** \brief Builds a thing from parts with materials. */
class ThingBuilder {
public:
  explicit ThingBuilder(const ThingRequest& request) : request_(request)
  {
    thing_.kind = request.kind;
  }

  /** \brief A new material; parts name it by the number returned. */
  int
  addMaterial(const Material& material)
  {
    thing_.materials.push_back(material);
    return static_cast<int>(thing_.materials.size()) - 1;
  }

  /** \brief Adds a part at a place; its triangles' materials count from 0. */
  void
  add(const Mesh& part, const Eigen::Affine3d& place = Eigen::Affine3d::Identity())
  {
    mesh_.append(part, place);
  }

  void
  add(const Mesh& part, const Eigen::Vector3d& place)
  {
    mesh_.append(part, Eigen::Affine3d(Eigen::Translation3d(place)));
  }

  /** \brief The mesh so far, e.g. to keep the faces of a box. */
  Mesh&
  mesh()
  {
    return mesh_;
  }

  Thing&
  thing()
  {
    return thing_;
  }

  /** \brief What was added so far is the thing; what comes protrudes from it and is not
   *  in its box. */
  void
  closeBox()
  {
    body_ = mesh_.bounds();
  }

  /** \brief Scales the whole to the size asked for, puts its foot's middle into the
   *  origin, and measures its box and the colour that most
   *  of its surface has. \param cuboid faces count as those of the box */
  Thing finish(bool cuboid = false);

private:
  const ThingRequest& request_;
  Thing thing_;
  Mesh mesh_;
  Eigen::AlignedBox3d body_;
};

/** \brief A round or rounded cross-section. */
inline Ring
ringAt(double z,
       double half_x,
       double half_y,
       double roundness = 1,
       bool crease = false)
{
  Ring ring;
  ring.z = z;
  ring.half_x = half_x;
  ring.half_y = half_y;
  ring.roundness = roundness;
  ring.crease = crease;
  return ring;
}

/** \brief The point of a circle around the z axis after a \a turn of it from x. */
inline Eigen::Vector3d
circlePoint(double turn, double radius, double z)
{
  return {radius * cosineOfTurns(turn), radius * sineOfTurns(turn), z};
}

/** \brief Which of \a count shapes of a class, count > 1: one to learn from, or one of
 *  the last third (at least one; of three to five the last), for testing only. */
int variantFor(const ThingRequest& request, int count, Random& random);

/** \brief The colour asked for, or one like those in the list. */
Rgb
pickColor(const ThingRequest& request, const std::vector<Rgb>& colors, Random& random);

/** \brief A stone: an ellipsoid with dents. */
Mesh stoneMesh(const Eigen::Vector3d& half, int material, Random& random);

/** \brief A material of one colour. */
inline Material
plainMaterial(const Rgb& color, Random& random, double gloss = 0.1)
{
  Material material;
  material.color = color;
  material.gloss = gloss;
  material.seed = random.bits();
  return material;
}

/** \brief A colour near another: every channel within \a spread, brightness alike. */
Rgb variedColor(const Rgb& color, double spread, Random& random);

Thing makeElement(const ThingRequest& request, Random& random);
Thing makeCone(const ThingRequest& request, Random& random);
Thing makeHat(const ThingRequest& request, Random& random);
Thing makeGloves(const ThingRequest& request, Random& random);
Thing makeGasContainer(const ThingRequest& request, Random& random);
Thing makeContainer(const ThingRequest& request, Random& random);
Thing makeChair(const ThingRequest& request, Random& random);
Thing makePlant(const ThingRequest& request, Random& random);
Thing makeWorksiteThing(const ThingRequest& request, Random& random);
Thing makeClutter(const ThingRequest& request, Random& random);

} // namespace simulation
} // namespace hoist
