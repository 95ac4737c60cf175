#include "generate.h"

#include "random.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hoist {
namespace samples {
namespace {

// A unit vector in the plane without cos and sin, whose last bits differ between
// machines.
Eigen::Vector2d
randomHeading(Random& random)
{
  for (;;) {
    const Eigen::Vector2d h(random.uniform(-1, 1), random.uniform(-1, 1));
    if (h.squaredNorm() > 0.01 && h.squaredNorm() < 1)
      return h.normalized();
  }
}

// Evenly distributed over all rotations.
Eigen::Matrix3d
randomRotation(Random& random)
{
  for (;;) {
    const Eigen::Vector4d q(random.uniform(-1, 1),
                            random.uniform(-1, 1),
                            random.uniform(-1, 1),
                            random.uniform(-1, 1));
    if (q.squaredNorm() > 0.01 && q.squaredNorm() < 1)
      return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  }
}

Rgb
randomColor(Random& random)
{
  Rgb rgb;
  for (auto& value : rgb)
    value = static_cast<unsigned char>(60 + random.index(170));
  return rgb;
}

Texture
randomTexture(Random& random)
{
  return static_cast<Texture>(random.index(5));
}

// Area of a convex quadrilateral in the image [px].
double
quadArea(const std::array<Eigen::Vector2d, 4>& q)
{
  double sum = 0;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector2d &a = q[i], &b = q[(i + 1) % 4];
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return std::abs(sum) / 2;
}

// Faces with at least min_px pixels, or -1 when a corner leaves the image.
int
facesInView(const Box& box, const Scene& scene, double min_px)
{
  constexpr double margin = 3; // [px]
  int faces = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {1, -1}) {
      const Eigen::Vector3d normal = side * box.axes.col(axis);
      const Eigen::Vector3d middle = box.center + normal * box.size[axis] / 2;
      const int b = (axis + 1) % 3, c = (axis + 2) % 3;
      std::array<Eigen::Vector2d, 4> corners;
      for (int k = 0; k < 4; ++k) {
        const double s = k == 0 || k == 3 ? 0.5 : -0.5, t = k < 2 ? 0.5 : -0.5;
        const Eigen::Vector3d p = middle + s * box.size[b] * box.axes.col(b) +
                                  t * box.size[c] * box.axes.col(c);
        if (p.z() < 0.2)
          return -1;
        corners[k] = scene.camera.project(p);
        if (corners[k].x() < margin || corners[k].x() > scene.width - 1 - margin ||
            corners[k].y() < margin || corners[k].y() > scene.height - 1 - margin)
          return -1;
      }
      if (normal.dot(middle) < 0 && quadArea(corners) >= min_px)
        ++faces;
    }
  return faces;
}

void
scaleCamera(Scene& scene)
{
  const double scale = scene.width / 640.0;
  scene.camera.fx *= scale;
  scene.camera.fy *= scale;
  scene.camera.cx = (scene.width - 1) / 2.0;
  scene.camera.cy = (scene.height - 1) / 2.0;
}

// What stands on the table: a rectangle with a height.
struct Footprint {
  Eigen::Vector2d center;
  Eigen::Vector2d heading;
  Eigen::Vector2d half;
  double bottom;
  double top;
  bool occupied; // something stands on it
};

// Separating axes of two rectangles, with a gap of a centimetre.
bool
overlap(const Footprint& a, const Footprint& b)
{
  constexpr double gap = 0.01;
  const auto reach = [](const Footprint& f, const Eigen::Vector2d& axis) {
    const Eigen::Vector2d side(-f.heading.y(), f.heading.x());
    return f.half.x() * std::abs(f.heading.dot(axis)) +
           f.half.y() * std::abs(side.dot(axis));
  };
  for (const Footprint* f : {&a, &b})
    for (const Eigen::Vector2d& axis :
         {f->heading, Eigen::Vector2d(-f->heading.y(), f->heading.x())})
      if (std::abs(axis.dot(a.center - b.center)) >
          reach(a, axis) + reach(b, axis) + gap)
        return false;
  return true;
}

} // namespace

View
View::lookAt(const Eigen::Vector3d& eye, const Eigen::Vector3d& target)
{
  const Eigen::Vector3d forward = (target - eye).normalized();
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  View view;
  view.sensor_to_world.linear() << right, forward.cross(right), forward;
  view.sensor_to_world.translation() = eye;
  return view;
}

Patch
View::ground(const Eigen::Vector2d& half_size, Texture texture, const Rgb& color) const
{
  const Eigen::Isometry3d to_sensor = sensor_to_world.inverse();
  Patch patch;
  patch.center = to_sensor.translation();
  patch.axes = to_sensor.linear();
  patch.half_size = half_size;
  patch.texture = texture;
  patch.color = color;
  return patch;
}

Box
View::box(const Eigen::Vector3d& foot,
          const Eigen::Vector2d& heading,
          const Eigen::Vector3d& size,
          Texture texture,
          const Rgb& color) const
{
  const Eigen::Vector2d h = heading.normalized();
  Eigen::Matrix3d axes;
  axes.col(0) << h, 0;
  axes.col(1) << -h.y(), h.x(), 0;
  axes.col(2) << 0, 0, 1;
  const Eigen::Isometry3d to_sensor = sensor_to_world.inverse();
  Box out;
  out.center = to_sensor * (foot + Eigen::Vector3d(0, 0, size.z() / 2));
  out.axes = to_sensor.linear() * axes;
  out.size = size;
  out.texture = texture;
  out.color = color;
  return out;
}

Cylinder
View::cylinder(const Eigen::Vector3d& foot,
               double radius,
               double height,
               const Rgb& color) const
{
  const Eigen::Isometry3d to_sensor = sensor_to_world.inverse();
  Cylinder out;
  out.center = to_sensor * (foot + Eigen::Vector3d(0, 0, height / 2));
  out.axis = to_sensor.linear().col(2);
  out.radius = radius;
  out.height = height;
  out.color = color;
  return out;
}

Scene
randomBoxScene(std::uint64_t seed, const RandomBoxOptions& options)
{
  Random random(seed);
  Scene scene;
  scene.name = "box" + std::to_string(seed);
  scene.seed = seed;
  scene.width = options.width;
  scene.height = options.height;
  scene.noise = options.noise;
  scaleCamera(scene);
  for (int attempt = 0; attempt < 10000; ++attempt) {
    const double distance = random.uniform(options.min_distance, options.max_distance);
    const double longest =
        distance * random.uniform(options.min_size_ratio, options.max_size_ratio);
    // the shortest side reaches the wanted aspect in one of two scenes
    const double least = longest / options.max_aspect;
    const double shortest =
        random.uniform() < 0.5 ? least : random.uniform(least, longest);
    Eigen::Vector3d size(longest, random.uniform(shortest, longest), shortest);
    Box box;
    scene.boxes.clear();
    scene.patches.clear();
    scene.has_support = false;
    if (options.on_ground) {
      const double rise = random.uniform(0.35, 0.85); // sine of the camera's elevation
      const Eigen::Vector3d eye =
          distance * Eigen::Vector3d(0, -std::sqrt(1 - rise * rise), rise);
      const View view = View::lookAt(eye, {0, 0, 0});
      box = view.box({0, 0, 0}, randomHeading(random), size, options.texture, {});
      scene.patches.push_back(view.ground(
          Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()),
          Texture::plain,
          {{140, 135, 130}}));
      scene.has_support = true;
      scene.pose = view.sensor_to_world;
    }
    else {
      box.axes = randomRotation(random);
      box.center = distance * scene.camera.ray(random.uniform(0.2, 0.8) * scene.width,
                                               random.uniform(0.2, 0.8) * scene.height);
      box.size = size;
    }
    box.texture = options.texture;
    box.color = randomColor(random);
    if (facesInView(box, scene, static_cast<double>(options.min_face_px)) <
        options.min_faces)
      continue;
    scene.boxes.push_back(box);
    return scene;
  }
  throw std::invalid_argument("randomBoxScene: no box fits these options");
}

Scene
randomTableScene(std::uint64_t seed, int n, const RandomTableOptions& options)
{
  Random random(seed ^ 0x7ab1e);
  Scene scene;
  scene.name = "table" + std::to_string(seed);
  scene.seed = seed;
  scene.width = options.width;
  scene.height = options.height;
  scene.noise = options.noise;
  scaleCamera(scene);
  const double rise = options.elevation, scale = options.distance / 1.2;
  const View view = View::lookAt(
      options.distance * Eigen::Vector3d(0, -std::sqrt(1 - rise * rise), rise),
      {0, 0, 0});
  scene.pose = view.sensor_to_world;
  scene.has_support = true;
  scene.patches.push_back(view.ground(
      scale * Eigen::Vector2d(0.55, 0.42), Texture::concrete, {{150, 145, 140}}));

  std::vector<Footprint> standing;
  const auto place = [&](Footprint& f, bool may_stack) {
    for (int attempt = 0; attempt < 200; ++attempt) {
      f.heading = randomHeading(random);
      f.occupied = false;
      Footprint* below = nullptr;
      if (may_stack && attempt < 50 && random.uniform() < options.stacked &&
          !standing.empty()) {
        below = &standing[random.index(static_cast<int>(standing.size()))];
        if (below->occupied || below->half.minCoeff() < f.half.maxCoeff() * 0.9)
          continue;
        f.center = below->center;
        f.heading = (below->heading + 0.3 * f.heading).normalized();
        const double height = f.top - f.bottom;
        f.bottom = below->top;
        f.top = f.bottom + height;
        below->occupied = true;
        return true;
      }
      f.center = scale * Eigen::Vector2d(random.uniform(-0.38, 0.38),
                                         random.uniform(-0.26, 0.26));
      if (std::none_of(standing.begin(), standing.end(), [&](const Footprint& other) {
            return overlap(f, other);
          }))
        return true;
    }
    return false;
  };

  for (int i = 0; i < n; ++i) {
    Eigen::Vector3d size;
    for (int k = 0; k < 3; ++k)
      size[k] = scale * random.uniform(0.05, 0.24);
    Footprint f{{}, {}, {size.x() / 2, size.y() / 2}, 0, size.z(), false};
    const Texture texture = randomTexture(random);
    const Rgb color = randomColor(random);
    if (!place(f, true))
      continue;
    standing.push_back(f);
    scene.boxes.push_back(view.box(
        {f.center.x(), f.center.y(), f.bottom}, f.heading, size, texture, color));
  }
  for (int i = 0; i < options.cylinders; ++i) {
    const double radius = scale * random.uniform(0.03, 0.06);
    const double height = scale * random.uniform(0.08, 0.2);
    Footprint f{{}, {}, {radius, radius}, 0, height, true};
    const Rgb color = randomColor(random);
    if (!place(f, false))
      continue;
    standing.push_back(f);
    scene.cylinders.push_back(
        view.cylinder({f.center.x(), f.center.y(), 0}, radius, height, color));
  }
  return scene;
}

} // namespace samples
} // namespace hoist
