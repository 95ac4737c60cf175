#pragma once

#include <hoist/data/annotation.h>
#include <hoist/data/intrinsics.h>
#include <hoist/simulation/material.h>
#include <hoist/simulation/mesh.h>

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace hoist {
namespace simulation {

/** \brief A thing in the world. World: z up, metres. */
struct Thing {
  std::string kind;       ///< of thingKinds(), or "ground", "wall", "table"
  std::string name;       ///< unique in its site; stays the same from visit to visit
  bool annotated = false; ///< part of the truth; else clutter
  int label = 0;          ///< 1 ... 65535 of annotated things, unique in a site

  std::shared_ptr<const Mesh> mesh;
  std::vector<Material> materials;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); ///< thing to world

  /// The box of the truth in the thing's frame: middle and full sides [m].
  Eigen::Vector3d box_center = Eigen::Vector3d::Zero();
  Eigen::Vector3d box_size = Eigen::Vector3d::Ones();
  ObjectSymmetry symmetry = ObjectSymmetry::box;
  bool is_cuboid = false;

  Rgb color = {{128, 128, 128}}; ///< albedo of most of it
  std::string substance;         ///< plastic, fabric, wood, organic, metal, concrete
  std::optional<bool> full;      ///< containers only: something protrudes
  double density = 0;       ///< of the truth's box [kg/m3]; 0 where no weight is known
  std::string supported_by; ///< name of the thing it stands on; "" the ground
  std::string mesh_file;    ///< where its shape came from; "" if made here
  bool minor = false;       ///< carries others, as timbers and pallets do: never counts

  std::optional<ObjectStatus> status;        ///< since the visit before
  std::optional<Eigen::Isometry3d> previous; ///< pose at the visit before, if moved
  std::string global_id;                     ///< in the building model

  double
  weight() const
  {
    return density * box_size.prod();
  }

  /** \brief Axes of the truth's box in the world. */
  Eigen::Matrix3d
  axes() const
  {
    return pose.linear();
  }

  /** \brief Centre of the truth's box in the world [m]. */
  Eigen::Vector3d
  center() const
  {
    return pose * box_center;
  }
};

/** \brief A lamp: a small ball that shines evenly. */
struct Lamp {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3f power = Eigen::Vector3f::Ones(); ///< irradiance at 1 m, by channel
};

/** \brief Where light comes from. Irradiances are relative, 1 that of a clear sky on
 *  a level surface: exposure sets the scale. */
struct Light {
  Eigen::Vector3d sun = Eigen::Vector3d::UnitZ();      ///< unit, towards it
  Eigen::Vector3f sun_power = Eigen::Vector3f::Zero(); ///< on a surface facing it
  Eigen::Vector3f sky_power = Eigen::Vector3f::Ones(); ///< on a level surface
  Eigen::Vector3f ground_bounce = Eigen::Vector3f::Constant(0.2f); ///< from below
  std::vector<Lamp> lamps;
};

enum class SensorKind { ideal, kinect, tof, stereo };

/** \brief "ideal", "kinect", "tof", "stereo". */
const char* toString(SensorKind kind);

/** \brief A camera that measures depth. Camera frame: x right, y down, z forward. */
struct Sensor {
  SensorKind kind = SensorKind::ideal;
  int width = 640;
  int height = 480;
  Intrinsics camera; ///< of the lens without its distortion
  /// k1 k2 p1 p2 k3, as OpenCV has them. Pixels are where the lens puts them; points
  /// are computed with the pinhole alone, as drivers do.
  std::array<double, 5> distortion{};
  /// What the driver believes the camera to be; the points of the cloud follow it.
  std::optional<Intrinsics> assumed;
  /// How wrongly colour is registered: shift [m] and turn [rad] of the colour camera
  /// against what the driver believes.
  Eigen::Vector3d registration_shift = Eigen::Vector3d::Zero();
  Eigen::Vector3d registration_turn = Eigen::Vector3d::Zero();

  double min_range = 0.1; ///< [m]
  double max_range = 30;  ///< [m]

  double noise = 1;          ///< factor on the model's depth noise; 0 for none
  double sigma_constant = 0; ///< tof: sigma = constant + quadratic z^2 [m], [1/m]
  double sigma_quadratic = 0;
  double baseline = 0;       ///< kinect: eye to projector; stereo: eye to eye [m]
  double focal_ir = 580;     ///< kinect: of the infrared camera [px]
  double disparity_step = 0; ///< kinect [px]
  double lateral = 0;        ///< displacement of edges [px], standard deviation
  double edge_loss = 0;      ///< share of pixels at a jump of depth without depth
  double grazing_loss = 0;   ///< share of pixels without depth seen at 80 degrees

  double color_noise = 1;    ///< factor on shot and read noise
  double exposure_error = 0; ///< [EV]
  std::array<double, 3> white_balance_gain = {{1, 1, 1}}; ///< left over after balancing
  double vignetting = 0.15; ///< loss of light in the corners, [0, 1)
  double blur = 0.5;        ///< of the lens, standard deviation [px]

  int max_disparity = 128;       ///< stereo: multiple of 16 [px]
  int block_size = 5;            ///< stereo: odd [px]
  double eye_misalignment = 0.1; ///< stereo: vertical error of rectification [px]

  /** \brief The camera that the points follow. */
  const Intrinsics&
  believed() const
  {
    return assumed ? *assumed : camera;
  }

  static Sensor ideal();
  static Sensor kinect();
  static Sensor tof();
  static Sensor stereo();
};

/** \brief All that is needed to make a frame. */
struct Scene {
  std::string name;
  std::uint64_t seed = 0; ///< of noise and of all patterns without a seed of their own
  std::vector<Thing> things;
  Light light;
  Sensor sensor;
  Eigen::Isometry3d sensor_to_world = Eigen::Isometry3d::Identity();
  double support_height = 0; ///< of the ground or table that things stand on [m]

  std::string sequence;       ///< name of the robot's way; "" for single frames
  int visit = 1;              ///< of the site, from 1
  int index = 0;              ///< of the frame in the visit, from 0
  double time = 0;            ///< since the start of the visit [s]
  std::vector<Thing> removed; ///< at the visit before, but not now
};

/** \brief A camera at \a eye that looks at \a target, upright but for \a roll [turns].
 */
Eigen::Isometry3d
lookAt(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, double roll = 0);

} // namespace simulation
} // namespace hoist
