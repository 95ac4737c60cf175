#include <hoist/simulation/random.h>
#include <hoist/simulation/scene.h>

namespace hoist {
namespace simulation {
namespace {

Intrinsics
pinhole(double focal, double cx, double cy)
{
  Intrinsics camera;
  camera.fx = camera.fy = focal;
  camera.cx = cx;
  camera.cy = cy;
  return camera;
}

} // namespace

const char*
toString(SensorKind kind)
{
  switch (kind) {
  case SensorKind::kinect:
    return "kinect";
  case SensorKind::tof:
    return "tof";
  case SensorKind::stereo:
    return "stereo";
  case SensorKind::ideal:
    break;
  }
  return "ideal";
}

Sensor
Sensor::ideal()
{
  Sensor sensor;
  sensor.camera = pinhole(525, 319.5, 239.5);
  sensor.noise = 0;
  return sensor;
}

Sensor
Sensor::kinect()
{
  Sensor sensor;
  sensor.kind = SensorKind::kinect;
  sensor.camera = pinhole(525, 319.5, 239.5);
  sensor.min_range = 0.5;
  sensor.max_range = 5;
  sensor.baseline = 0.075;
  sensor.disparity_step = 0.125;
  sensor.lateral = 0.8;
  sensor.edge_loss = 0.5;
  sensor.grazing_loss = 0.6;
  return sensor;
}

Sensor
Sensor::tof()
{
  Sensor sensor;
  sensor.kind = SensorKind::tof;
  sensor.camera = pinhole(560, 319.5, 239.5);
  sensor.min_range = 0.3;
  sensor.max_range = 12;
  sensor.sigma_constant = 0.003;
  sensor.sigma_quadratic = 0.0002;
  sensor.edge_loss = 0.4;
  sensor.grazing_loss = 0.5;
  return sensor;
}

Sensor
Sensor::stereo()
{
  Sensor sensor;
  sensor.kind = SensorKind::stereo;
  sensor.width = 1024;
  sensor.height = 768;
  sensor.camera = pinhole(810, 511.5, 383.5);
  sensor.min_range = 1.25;
  sensor.max_range = 20;
  sensor.baseline = 0.24;
  return sensor;
}

Eigen::Isometry3d
lookAt(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, double roll)
{
  const Eigen::Vector3d z = (target - eye).normalized();
  Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ());
  if (x.squaredNorm() < 1e-12) // straight down or up
    x = Eigen::Vector3d::UnitX();
  x.normalize();
  const Eigen::Vector3d y = z.cross(x);
  const double c = cosineOfTurns(roll), s = sineOfTurns(roll);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear().col(0) = c * x + s * y;
  pose.linear().col(1) = c * y - s * x;
  pose.linear().col(2) = z;
  pose.translation() = eye;
  return pose;
}

} // namespace simulation
} // namespace hoist
