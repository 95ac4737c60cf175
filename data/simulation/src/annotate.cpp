#include <hoist/simulation/simulate.h>

#include <algorithm>
#include <cmath>

namespace hoist {
namespace simulation {
namespace {

// The rules of what counts; those of visibility are mOSD's.
constexpr double least_visible = 0.4;
constexpr double most_cut = 0.1;
constexpr std::int64_t least_pixels = 250;
constexpr int face_pixels = 10;

struct Counts {
  std::int64_t visible = 0;
  std::array<std::int64_t, 6> faces{};
  int left = 1 << 20, top = 1 << 20, right = -1, bottom = -1;
};

std::vector<Counts>
countPixels(const Scene& scene, const Layer& layer)
{
  std::vector<Counts> counts(scene.things.size());
  for (int v = 0; v < layer.thing.rows; ++v)
    for (int u = 0; u < layer.thing.cols; ++u) {
      const int thing = layer.thing(v, u);
      if (thing < 0)
        continue;
      Counts& one = counts[static_cast<std::size_t>(thing)];
      ++one.visible;
      if (layer.face(v, u) < 6)
        ++one.faces[layer.face(v, u)];
      one.left = std::min(one.left, u);
      one.right = std::max(one.right, u);
      one.top = std::min(one.top, v);
      one.bottom = std::max(one.bottom, v);
    }
  return counts;
}

// Pixels that a thing would cover if nothing else were there.
struct Alone {
  double inside = 0;  ///< in the image
  double outside = 0; ///< beyond it, up to half the image's size
};

Alone
countAlone(const Scene& scene,
           const RayCaster& caster,
           const Lens& lens,
           const Layer& layer,
           int number)
{
  const Thing& thing = scene.things[static_cast<std::size_t>(number)];
  const Sensor& sensor = scene.sensor;
  const Eigen::Isometry3d to_camera = scene.sensor_to_world.inverse();
  const int margin_x = sensor.width / 2, margin_y = sensor.height / 2;
  int left = 1 << 20, top = 1 << 20, right = -(1 << 20), bottom = -(1 << 20);
  bool behind = false;
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d p = thing.box_center;
    for (int i = 0; i < 3; ++i)
      p[i] += (corner >> i & 1 ? 0.5 : -0.5) * thing.box_size[i];
    p = to_camera * (thing.pose * p);
    behind = behind || p.z() < 0.05;
    if (behind)
      break;
    const Eigen::Vector2d pixel =
        lens.project(p).cwiseMax(-1e6).cwiseMin(1e6); // before it becomes an int
    left = std::min(left, static_cast<int>(std::floor(pixel.x())));
    right = std::max(right, static_cast<int>(std::ceil(pixel.x())));
    top = std::min(top, static_cast<int>(std::floor(pixel.y())));
    bottom = std::max(bottom, static_cast<int>(std::ceil(pixel.y())));
  }
  if (behind) {
    left = top = -(1 << 20);
    right = bottom = 1 << 20;
  }
  // two pixels more: the lens bends straight edges
  left = std::max(left - 2, -margin_x);
  right = std::min(right + 2, sensor.width + margin_x);
  top = std::max(top - 2, -margin_y);
  bottom = std::min(bottom + 2, sensor.height + margin_y);

  Alone alone;
  const Eigen::Vector3d origin = scene.sensor_to_world.translation();
  for (int v = top; v <= bottom; ++v)
    for (int u = left; u <= right; ++u) {
      const bool in = u >= 0 && v >= 0 && u < sensor.width && v < sensor.height;
      if (!in && ((u | v) & 3) != 0) // outside every fourth each way will do
        continue;
      if ((in && layer.thing(v, u) == number) || // what is seen needs no ray
          caster.meets(number, origin, scene.sensor_to_world.linear() * lens.ray(u, v)))
        (in ? alone.inside : alone.outside) += in ? 1 : 16;
    }
  return alone;
}

void
judge(AnnotatedObject& object, const Thing& thing, double cut)
{
  if (*object.visible_fraction < least_visible)
    object.difficult_reasons.emplace_back("hidden");
  if (cut > most_cut)
    object.difficult_reasons.emplace_back("cut by the border");
  if (*object.visible_pixels < least_pixels)
    object.difficult_reasons.emplace_back("tiny");
  if (thing.minor)
    object.difficult_reasons.emplace_back("support");
  object.difficult = !object.difficult_reasons.empty();
}

// What is true of a thing wherever it is seen from.
AnnotatedObject
describe(const Thing& thing, const Eigen::Isometry3d& to_camera)
{
  AnnotatedObject object;
  object.label = thing.label;
  object.object_class = thing.kind;
  object.is_cuboid = thing.is_cuboid;
  object.center = to_camera * thing.center();
  object.size = thing.box_size;
  object.rotation = to_camera.linear() * thing.axes();
  object.symmetry = thing.symmetry;
  object.material = thing.substance;
  object.base_rgb =
      std::array<int, 3>{{thing.color[0], thing.color[1], thing.color[2]}};
  object.fullness = thing.full;
  if (thing.density > 0)
    object.weight = thing.weight();
  object.status = thing.status;
  object.global_id = thing.global_id;
  if (thing.previous) {
    Eigen::Isometry3d before = to_camera * *thing.previous;
    before.translation() = to_camera * (*thing.previous * thing.box_center);
    object.moved_from = before;
  }
  return object;
}

} // namespace

FrameAnnotation
annotate(const Scene& scene, const RayCaster& caster, const Layer& layer)
{
  const Sensor& sensor = scene.sensor;
  const Eigen::Isometry3d to_camera = scene.sensor_to_world.inverse();
  FrameAnnotation truth;
  truth.scene = scene.name;
  truth.width = sensor.width;
  truth.height = sensor.height;
  truth.sensor = sensor.kind == SensorKind::tof ? "depth" : toString(sensor.kind);
  if (sensor.baseline != 0)
    truth.baseline = sensor.baseline;
  truth.seed = scene.seed;
  truth.intrinsics = sensor.camera;
  if (sensor.distortion != std::array<double, 5>{})
    truth.distortion.assign(sensor.distortion.begin(), sensor.distortion.end());
  truth.pose = scene.sensor_to_world;
  const Eigen::Vector3d up = to_camera.linear().col(2);
  const double above = scene.sensor_to_world.translation().z() - scene.support_height;
  truth.support_plane =
      Eigen::Vector4d(up.x(), up.y(), up.z(), above) * (above < 0 ? -1.0 : 1.0);
  truth.sequence = scene.sequence;
  if (!scene.sequence.empty()) {
    truth.visit = scene.visit;
    truth.index = scene.index;
    truth.time = scene.time;
  }

  const Lens lens(sensor.camera, sensor.distortion);
  const std::vector<Counts> counts = countPixels(scene, layer);
  for (std::size_t i = 0; i < scene.things.size(); ++i) {
    const Thing& thing = scene.things[i];
    const Counts& seen = counts[i];
    if (!thing.annotated || seen.visible == 0)
      continue;
    AnnotatedObject object = describe(thing, to_camera);
    const Alone alone = countAlone(scene, caster, lens, layer, static_cast<int>(i));
    object.visible_pixels = seen.visible;
    object.visible_fraction =
        std::min(1.0, static_cast<double>(seen.visible) / std::max(1.0, alone.inside));
    object.box_2d = std::array<double, 4>{{static_cast<double>(seen.left),
                                           static_cast<double>(seen.top),
                                           seen.right - seen.left + 1.0,
                                           seen.bottom - seen.top + 1.0}};
    if (thing.is_cuboid) {
      std::array<bool, 6> faces{};
      int count = 0;
      for (std::size_t f = 0; f < 6; ++f) {
        faces[f] = seen.faces[f] >= face_pixels;
        count += faces[f] ? 1 : 0;
      }
      object.observed_faces = faces;
      object.faces_visible = count;
    }
    const double cut = alone.outside / std::max(1.0, alone.inside + alone.outside);
    judge(object, thing, cut);
    truth.objects.push_back(object);
  }
  for (const Thing& thing : scene.removed)
    truth.removed.push_back(describe(thing, to_camera));
  return truth;
}

} // namespace simulation
} // namespace hoist
