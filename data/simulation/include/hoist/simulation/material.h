#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <string>

namespace hoist {
namespace simulation {

using Rgb = std::array<unsigned char, 3>;

/** \brief Patterns; each is a function of the place on the thing, so that it does not
 *  swim when the thing moves. */
enum class Texture {
  plain,
  concrete, ///< blotches, grain and pores
  wood,     ///< boards with grain
  print,    ///< a printed carton: panels, a disc, lines of text, tape
  rust,     ///< paint or steel with rust through it
  brick,    ///< courses of bricks with joints
  fabric,   ///< weave
  asphalt,  ///< fine bright and dark stones
  soil,     ///< lumps and grains
  plaster,  ///< nearly plain wall
  stripes,  ///< slanted bands of the two colours
  leaf      ///< veins and spots
};

/** \brief What a surface looks like. */
struct Material {
  Texture texture = Texture::plain;
  Rgb color = {{150, 150, 150}}; ///< albedo, sRGB; the mean of the pattern
  Rgb second = {{60, 60, 60}};   ///< ink, joints, stripes, rust
  double scale = 1;              ///< of the pattern; 1 is the natural size, > 0
  double contrast = 1;           ///< of the pattern, >= 0
  double stains = 0;             ///< 0 clean .. 1 dirty
  double gloss = 0;              ///< specular reflectance, [0, 1]
  bool metal = false;            ///< reflections take the surface's colour
  std::uint64_t seed = 0;
};

/** \brief Albedo at a place of a surface, linear (not sRGB), each in [0, 1].
 *
 * \param p place in the thing's frame [m]
 * \param n unit normal in the thing's frame
 * \param half half the sides of the thing's box [m]
 * \param footprint width of a pixel there [m]; finer detail is averaged away
 */
Eigen::Vector3f albedo(const Material& material,
                       const Eigen::Vector3d& p,
                       const Eigen::Vector3d& n,
                       const Eigen::Vector3d& half,
                       double footprint);

/** \brief sRGB 0..255 to linear 0..1. */
Eigen::Vector3f linear(const Rgb& color);

/** \brief Linear to sRGB 0..1, clipped. */
float encodeSrgb(float linear);

} // namespace simulation
} // namespace hoist
