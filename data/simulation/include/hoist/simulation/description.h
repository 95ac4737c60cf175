#pragma once

#include <hoist/simulation/scene.h>
#include <hoist/simulation/things.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace hoist {
namespace simulation {

/** \brief A number to be drawn evenly from [low, high]. */
struct Range {
  double low = 0;
  double high = 0;
  int line = 0; ///< of the file

  double
  draw(Random& random) const
  {
    return random.uniform(low, high);
  }

  /** \brief A whole number from low to high, each as likely; both are whole. */
  int
  drawWhole(Random& random) const
  {
    const auto number = static_cast<int>(std::floor(random.uniform(low, high + 1)));
    return std::min(number, static_cast<int>(high)); // rounding may reach high + 1
  }
};

/** \brief Things of one sort. */
struct ThingGroup {
  int line = 0;
  std::vector<std::string> kinds; ///< one is drawn for every thing
  Range count = {1, 1};
  std::string name; ///< of the thing, or of the first of several; "" makes one
  std::optional<std::array<Range, 3>> size;
  std::vector<Rgb> colors;
  std::vector<Texture> textures;
  std::optional<Range> wear;
  double full = 0.5;                      ///< chance that a container is full
  std::optional<std::array<Range, 2>> at; ///< [m]
  std::optional<Range> heading;           ///< [degrees]
  std::optional<Range> lift;              ///< above the ground [m], afloat
  double stacked = 0;                     ///< chance to stand on an earlier thing
  double touching = 0;                    ///< chance to stand against an earlier thing
  double timbers = 0;                     ///< chance to lie on timbers
  double tipped = 0;                      ///< chance to lie on its side
  std::string mesh;                       ///< file; relative to the description's
  double library_share = 0; ///< chance that the shape is one of the mesh library
  std::string split;        ///< of the mesh library: "train", "test", ""
};

/** \brief What a scene is drawn from. Lengths in metres, angles in degrees. */
struct Description {
  std::string name = "scene";
  Sensor sensor;
  /// Spread of what differs from frame to frame about the sensor.
  Range exposure = {0, 0};            ///< error [EV]
  double white_balance_error = 0;     ///< of every channel's gain, largest
  double registration_error = 0;      ///< shift of colour [m], largest
  double registration_turn_error = 0; ///< turn of colour [degrees], largest

  Range distance = {2, 4};    ///< of the camera from what it looks at
  Range elevation = {20, 50}; ///< of the camera above the horizon there
  Range azimuth = {0, 360};
  Range roll = {-3, 3};
  double target_jitter = 0.3; ///< of what it looks at, as a share of the distance
  std::optional<Eigen::Vector3d> eye, target; ///< instead of the above

  std::array<double, 2> area = {{6, 6}};     ///< sides of the rectangle for things
  std::optional<std::array<Range, 3>> table; ///< size of a table that is the area
  std::vector<Texture> ground = {Texture::concrete};
  std::vector<Rgb> ground_colors;
  std::optional<Range> walls; ///< how many of the four sides have one
  double wall_distance = 1;   ///< from the area's rim
  double wall_height = 3;

  double sun = 1; ///< chance that it shines
  Range sun_elevation = {15, 65};
  Range sun_power = {1, 4}; ///< relative to the sky's light
  Range sky_power = {1, 1};
  Range lamps = {0, 0}; ///< how many
  Range lamp_height = {2.4, 3.5};
  Range lamp_power = {2, 6};

  std::vector<ThingGroup> things;

  /// A robot's visits to one site; 0 makes a new scene for every frame.
  int visits = 0;
  int frames_per_visit = 0;
  double added = 0, moved = 0, gone = 0; ///< share of things, between two visits
};

/** \brief Reads a description in YAML; all settings are listed in docs/simulation.md.
 *  \param file its name, for messages and for meshes beside it
 *  \throws LoadError "file:line: reason" for what is not YAML, unknown settings and bad
 *          values */
Description parseDescription(const std::string& text, const std::string& file);

/** \brief The same from a file.
 *  \throws LoadError */
Description loadDescription(const std::string& file);

/** \brief The name of frame \a number, e.g. "yard-000017"; makes no scene. */
std::string frameName(const Description& description, int number);

/** \brief Scene::seed of frame \a number, which its truth names. */
std::uint64_t frameSeed(std::uint64_t seed, int number);

/** \brief The scene of frame \a number. For sites of several visits consecutive numbers
 *  are the frames of the visits of one site after the other.
 *  \throws LoadError if a mesh cannot be used */
Scene makeScene(const Description& description, std::uint64_t seed, int number);

/** \brief What the building model says of a site, as JSON: the elements as planned,
 *  in the world's frame. \param number of any of its frames */
std::string plannedSite(const Description& description, std::uint64_t seed, int number);

} // namespace simulation
} // namespace hoist
