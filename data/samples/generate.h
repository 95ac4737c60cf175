#pragma once

#include "scene.h"

#include <cstdint>
#include <vector>

namespace hoist {
namespace samples {

/** \brief Where the camera stands. World: z up, metres, the origin on the ground. */
struct View {
  Eigen::Isometry3d sensor_to_world = Eigen::Isometry3d::Identity();

  /** \brief A camera at \a eye that looks at \a target with its image upright. */
  static View lookAt(const Eigen::Vector3d& eye, const Eigen::Vector3d& target);

  /** \brief A rectangle of the ground around the world's origin; \a half_size [m]. */
  Patch
  ground(const Eigen::Vector2d& half_size, Texture texture, const Rgb& color) const;

  /** \brief A box that stands at (x, y), its lower side at height z, its first axis
   *  along (heading_x, heading_y). */
  Box box(const Eigen::Vector3d& foot,
          const Eigen::Vector2d& heading,
          const Eigen::Vector3d& size,
          Texture texture,
          const Rgb& color) const;

  /** \brief An upright cylinder, its lower end at \a foot. */
  Cylinder cylinder(const Eigen::Vector3d& foot,
                    double radius,
                    double height,
                    const Rgb& color) const;
};

/** \brief What randomBoxScene() may choose. */
struct RandomBoxOptions {
  double min_distance = 0.6; ///< of the box's centre [m]
  double max_distance = 4.0;
  double max_aspect = 4.0;     ///< longest to shortest side, >= 1; 20 gives slabs
  double min_size_ratio = 0.1; ///< longest side to distance
  double max_size_ratio = 0.6;
  bool on_ground = false;        ///< on an endless ground; otherwise afloat before NaN
  int min_faces = 3;             ///< that many faces at least are seen
  std::size_t min_face_px = 400; ///< area of each of them [px]
  Texture texture = Texture::plain;
  Noise noise;
  int width = 640;
  int height = 480;
};

/** \brief One box, wholly in the image, in a random pose.
 *
 * \throws std::invalid_argument if the options leave no choice (10000 tries fail)
 */
Scene randomBoxScene(std::uint64_t seed, const RandomBoxOptions& options = {});

/** \brief What randomTableScene() may choose. */
struct RandomTableOptions {
  double stacked = 0.3;   ///< chance that a box stands on an earlier one, if it fits
  int cylinders = 1;      ///< as many cylinders among them at most
  double distance = 1.2;  ///< of the camera from the table's centre [m]
  double elevation = 0.8; ///< sine of the camera's angle above the table, (0, 1)
  Noise noise = Noise::kinect();
  int width = 640;
  int height = 480;
};

/** \brief Boxes that do not intersect, on a table top, some on top of others.
 *
 * \param n boxes; fewer where the table is full
 */
Scene
randomTableScene(std::uint64_t seed, int n, const RandomTableOptions& options = {});

/** \brief The scenes in data/samples/scenes. */
std::vector<Scene> sampleScenes();

} // namespace samples
} // namespace hoist
