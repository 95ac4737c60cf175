#include <hoist/simulation/measure.h>
#include <hoist/simulation/random.h>
#include <hoist/simulation/simulate.h>

#include <opencv2/imgproc.hpp>

#include <cmath>
#include <vector>

namespace hoist {
namespace simulation {
namespace {

Exposure
exposureOf(const Scene& scene, const char* eye)
{
  Exposure exposure;
  exposure.error = scene.sensor.exposure_error;
  exposure.gain = scene.sensor.white_balance_gain;
  exposure.noise = scene.sensor.color_noise;
  exposure.vignetting = scene.sensor.vignetting;
  exposure.blur = scene.sensor.blur;
  exposure.seed = subSeed(scene.seed, eye);
  return exposure;
}

bool
misregistered(const Sensor& sensor)
{
  return !sensor.registration_shift.isZero(0) || !sensor.registration_turn.isZero(0);
}

// Where the colour camera really stands, against where the driver believes it does.
Eigen::Isometry3d
registrationError(const Sensor& sensor)
{
  Eigen::Isometry3d error = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d& turn = sensor.registration_turn;
  const double angle = turn.norm();
  if (angle > 0) {
    // Rodrigues' formula, with sines that are the same everywhere
    constexpr double turns = 0.15915494309189535; // 1 / (2 pi)
    const Eigen::Vector3d axis = turn / angle;
    Eigen::Matrix3d cross;
    cross << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
    error.linear() += sineOfTurns(angle * turns) * cross +
                      (1 - cosineOfTurns(angle * turns)) * cross * cross;
  }
  error.translation() = sensor.registration_shift;
  return error;
}

cv::Mat1f
stereoDepth(const RayCaster& caster,
            const Scene& scene,
            const cv::Mat3b& right,
            double key)
{
  const Sensor& sensor = scene.sensor;
  Eigen::Isometry3d left_pose = scene.sensor_to_world;
  left_pose.translation() -=
      scene.sensor_to_world.linear() * Eigen::Vector3d(sensor.baseline, 0, 0);
  Intrinsics left_camera = sensor.camera;
  left_camera.cy += sensor.eye_misalignment;
  Exposure exposure = exposureOf(scene, "left eye");
  exposure.key = key; // both eyes share their shutter
  const Lens lens(left_camera, sensor.distortion);
  const cv::Mat3b left = photograph(caster,
                                    scene,
                                    lens,
                                    castPixels(caster, lens, right.size(), left_pose),
                                    left_pose,
                                    exposure);
  cv::Mat1b grey_right, grey_left;
  cv::cvtColor(right, grey_right, cv::COLOR_BGR2GRAY);
  cv::cvtColor(left, grey_left, cv::COLOR_BGR2GRAY);
  return matchStereo(sensor, grey_right, grey_left);
}

// A thing that is seen, but of which the sensor measures next to nothing, counts
// neither way.
void
markUnmeasured(Frame& frame)
{
  std::vector<std::int64_t> measured(65536);
  for (int v = 0; v < frame.depth.rows; ++v)
    for (int u = 0; u < frame.depth.cols; ++u)
      if (std::isfinite(frame.depth(v, u)))
        ++measured[frame.instances(v, u)];
  for (AnnotatedObject& object : frame.truth.objects)
    if (2 * measured[static_cast<std::size_t>(object.label)] < *object.visible_pixels) {
      object.difficult = true;
      object.difficult_reasons.emplace_back("not measured");
    }
}

} // namespace

Frame
simulate(const Scene& scene)
{
  const Sensor& sensor = scene.sensor;
  const RayCaster caster(scene);
  const Lens lens(sensor.camera, sensor.distortion);
  const cv::Size size(sensor.width, sensor.height);

  Frame frame;
  frame.camera = sensor.believed();
  frame.pose = scene.sensor_to_world;
  PixelHits seen = castPixels(caster, lens, size, scene.sensor_to_world);
  frame.exact = layerOf(seen, lens, scene.sensor_to_world);
  Eigen::Isometry3d color_pose = scene.sensor_to_world;
  if (misregistered(sensor)) {
    color_pose = color_pose * registrationError(sensor);
    seen = castPixels(caster, lens, size, color_pose);
  }
  double key = 0;
  frame.color = photograph(
      caster, scene, lens, seen, color_pose, exposureOf(scene, "right eye"), &key);
  frame.depth = sensor.kind == SensorKind::stereo
                    ? stereoDepth(caster, scene, frame.color, key)
                    : measureDepth(caster, scene, frame.exact, lens);
  frame.truth = annotate(scene, caster, frame.exact);
  if (misregistered(sensor))
    frame.truth.registration = registrationError(sensor).inverse();
  frame.instances.create(size);
  for (int v = 0; v < size.height; ++v)
    for (int u = 0; u < size.width; ++u) {
      const int thing = frame.exact.thing(v, u);
      frame.instances(v, u) = static_cast<std::uint16_t>(
          thing >= 0 ? scene.things[static_cast<std::size_t>(thing)].label : 0);
    }
  markUnmeasured(frame);
  return frame;
}

} // namespace simulation
} // namespace hoist
