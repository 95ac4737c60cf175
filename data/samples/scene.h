#pragma once

#include <hoist/data/intrinsics.h>
#include <hoist/data/sensor_model.h>

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace hoist {
namespace samples {

/** \brief What a surface looks like. Patterns are a function of the position on the
 *  face in metres, so that they do not swim when the box moves. */
enum class Texture {
  plain,    ///< the base colour
  print,    ///< a printed carton: panels, a disc, lines of text
  wood,     ///< planks with grain
  concrete, ///< blotches and pits
  stripes   ///< bands of light and dark, 4 cm
};

using Rgb = std::array<unsigned char, 3>;

/** \brief A box; size(i) lies along column i of axes. Camera frame, metres. */
struct Box {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity(); ///< orthonormal, right-handed
  Eigen::Vector3d size = Eigen::Vector3d::Ones();     ///< full side lengths, > 0
  Rgb color = {{180, 140, 90}};
  Texture texture = Texture::plain;
};

/** \brief A closed cylinder: a thing that is no cuboid. Camera frame, metres. */
struct Cylinder {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitY(); ///< unit
  double radius = 0.05;
  double height = 0.2;
  Rgb color = {{120, 120, 160}};
  Texture texture = Texture::plain;
};

/** \brief A rectangle, or a whole plane: ground, table top or wall. */
struct Patch {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity(); ///< column 2 is the normal
  Eigen::Vector2d half_size =                         ///< [m], along columns 0 and 1
      Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Rgb color = {{140, 135, 130}};
  Texture texture = Texture::plain;
};

/** \brief How depth and colour are disturbed. */
struct Noise {
  bool enabled = false; ///< false: exact depth and colour at every pixel
  SensorModel sensor;
  /// Step of the disparity [px]; the Kinect's is 1/8. 0 for none.
  double disparity_step = 0.125;
  /// Distance between the two eyes along +x [m] (projector or second camera); what the
  /// second eye does not see has no depth. Negative: it stands on the left.
  double baseline = 0.075;
  double dropout = 0.5;       ///< share of silhouette pixels without depth, [0, 1]
  double lateral_sigma = 0.5; ///< depth is taken that far from its pixel [px]
  double color_sigma = 1.5;   ///< grey levels

  static Noise
  none()
  {
    return {};
  }

  static Noise
  kinect()
  {
    Noise noise;
    noise.enabled = true;
    return noise;
  }

  /** \param focal_baseline f * B [px m] \param baseline B [m] */
  static Noise
  stereo(double focal_baseline, double baseline, double sigma_disparity = 0.2)
  {
    Noise noise;
    noise.enabled = true;
    noise.sensor = SensorModel::stereo(focal_baseline, sigma_disparity);
    noise.disparity_step = 1.0 / 16.0;
    noise.baseline = -baseline; // the Bumblebee's reference eye is the right one
    return noise;
  }
};

/** \brief All that is needed to render a frame. Camera frame: x right, y down, z
 *  forward, metres. */
struct Scene {
  std::string name = "scene";
  int width = 640;
  int height = 480;
  Intrinsics camera = kinectCamera();

  std::vector<Box> boxes;
  std::vector<Cylinder> cylinders;
  /// The first patch is the support plane of the truth if has_support is set.
  std::vector<Patch> patches;
  bool has_support = false;

  Eigen::Vector3d light = Eigen::Vector3d(-0.4, -0.8, -0.45); ///< towards the light
  double ambient = 0.4;      ///< share of light that has no direction, [0, 1]
  bool shadows = true;       ///< things cast shadows in the light
  Eigen::Vector3d illuminant ///< colour of the light, 1 1 1 is white
      = Eigen::Vector3d::Ones();
  int supersampling = 2; ///< colour samples per pixel and direction, >= 1

  Noise noise;
  std::uint64_t seed = 0; ///< of texture and noise

  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); ///< sensor to world
  bool pose_known = false;

  /** \brief The camera of the Kinect's registered frames at 640 x 480. */
  static Intrinsics
  kinectCamera()
  {
    Intrinsics camera;
    camera.fx = camera.fy = 525.0;
    camera.cx = 319.5;
    camera.cy = 239.5;
    return camera;
  }

  /** \brief The Bumblebee's at 320 x 240, as recovered from a real file of it. */
  static Intrinsics
  bumblebeeCamera()
  {
    Intrinsics camera;
    camera.fx = camera.fy = 145.22 * 2; // that file's lens is very wide; ours half so
    camera.cx = 160.345;
    camera.cy = 120.006;
    return camera;
  }
};

} // namespace samples
} // namespace hoist
