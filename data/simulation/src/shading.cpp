#include "shading.h"

#include <hoist/simulation/random.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hoist {
namespace simulation {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

// x^n for a whole number; std::pow may differ from one C library to the next.
float
power(float x, int n)
{
  float result = 1;
  for (; n > 0; n /= 2, x *= x)
    if (n % 2 == 1)
      result *= x;
  return result;
}

} // namespace

Place
placeOf(const RayCaster& caster,
        const Vector3d& origin,
        const Vector3d& direction,
        const Hit& hit,
        double pixel_angle)
{
  Place place;
  place.position = origin + hit.distance * direction;
  place.normal = hit.normal;
  place.shade = caster.shadingNormal(hit);
  const double length = direction.norm();
  place.view = -direction / length;
  const double slant = std::max(0.15, place.normal.dot(place.view));
  // a slanted pixel is long in one direction only: the mean of both
  place.footprint = pixel_angle * hit.distance * length / std::sqrt(slant);
  return place;
}

void
directLight(const RayCaster& caster,
            const Light& light,
            const Place* places,
            int count,
            std::vector<float>* visible)
{
  Vector3d starts[4], ways[4];
  double fars[4];
  for (int i = 0; i < 4; ++i) {
    const Place& place = places[std::min(i, count - 1)];
    starts[i] = place.position + place.normal * (2e-4 + 2e-5 * place.position.norm());
  }
  // a light behind a surface needs no ray; far = 0 leaves it out
  const auto cast = [&](std::size_t number) {
    bool blocked[4];
    caster.blocked4(starts, ways, fars, blocked);
    for (int i = 0; i < count; ++i)
      visible[i][number] = fars[i] > 0 && !blocked[i] ? 1.0f : 0.0f;
  };
  const auto faces = [&](int i) {
    return i < count && places[i].normal.dot(ways[i]) > 0 &&
           places[i].shade.dot(ways[i]) > 0;
  };
  for (int i = 0; i < count; ++i)
    visible[i].assign(1 + light.lamps.size(), 0.0f);
  if (light.sun_power.maxCoeff() > 0) {
    for (int i = 0; i < 4; ++i) {
      ways[i] = light.sun;
      fars[i] = faces(i) ? std::numeric_limits<double>::infinity() : 0;
    }
    cast(0);
  }
  for (std::size_t lamp = 0; lamp < light.lamps.size(); ++lamp) {
    for (int i = 0; i < 4; ++i) {
      ways[i] = light.lamps[lamp].position - starts[i];
      fars[i] = faces(i) ? 0.98 : 0;
    }
    cast(lamp + 1);
  }
}

float
openSky(const RayCaster& caster, const Place& place, double reach, std::uint64_t number)
{
  const Vector3d side = place.normal.unitOrthogonal(), up = place.normal.cross(side);
  const Vector3d start =
      place.position + place.normal * (1e-3 + 2e-5 * place.position.norm());
  constexpr int rays = 8;
  const double turn = hash01(0x0c, static_cast<std::int64_t>(number));
  const double lift = hash01(0x0d, static_cast<std::int64_t>(number));
  Vector3d origins[rays], directions[rays];
  double fars[rays];
  for (int i = 0; i < rays; ++i) {
    // cosine-weighted: equal areas of the disc below the hemisphere
    const double r2 = (i + lift) / rays, r = std::sqrt(r2);
    const double t = turn + i * 0.381966;
    directions[i] = side * (r * cosineOfTurns(t)) + up * (r * sineOfTurns(t)) +
                    place.normal * std::sqrt(1 - r2);
    origins[i] = start;
    fars[i] = reach;
  }
  bool blocked[rays];
  caster.blocked4(origins, directions, fars, blocked);
  caster.blocked4(origins + 4, directions + 4, fars + 4, blocked + 4);
  int open = 0;
  for (const bool one : blocked)
    open += one ? 0 : 1;
  return static_cast<float>(open) / rays;
}

Vector3f
shadeOf(const Scene& scene,
        const Hit& hit,
        const Place& place,
        const std::vector<float>& direct,
        float open)
{
  const Thing& thing = scene.things[static_cast<std::size_t>(hit.thing)];
  const Mesh::Triangle& triangle = thing.mesh->triangles[hit.triangle];
  const Material& material = thing.materials[std::min<std::size_t>(
      triangle.material, thing.materials.size() - 1)];
  const Eigen::Isometry3d to_thing = thing.pose.inverse();
  const Vector3f color = albedo(material,
                                to_thing * place.position - thing.box_center,
                                to_thing.linear() * place.normal,
                                thing.box_size / 2,
                                place.footprint);
  const Light& light = scene.light;
  // diffuse: sky from above, ground from below
  const auto up = static_cast<float>(place.shade.z());
  Vector3f irradiance =
      light.sky_power * (open * (0.5f + 0.5f * up)) +
      light.ground_bounce * ((0.4f + 0.6f * open) * (0.5f - 0.5f * up));
  Vector3f shine = Vector3f::Zero();
  const auto addSource = [&](const Vector3d& way, const Vector3f& strength) {
    const auto slope = static_cast<float>(std::max(0.0, place.shade.dot(way)));
    irradiance += strength * slope;
    if (material.gloss > 0) {
      const Vector3d half = (way + place.view).normalized();
      const auto facing = static_cast<float>(std::max(0.0, place.shade.dot(half)));
      const int sharpness = material.metal ? 24 : 60;
      shine += strength * (power(facing, sharpness) * slope *
                           static_cast<float>(material.gloss * (sharpness + 8) / 25));
    }
  };
  if (direct[0] > 0)
    addSource(light.sun, light.sun_power * direct[0]);
  for (std::size_t i = 0; i < light.lamps.size(); ++i)
    if (direct[i + 1] > 0) {
      const Vector3d way = light.lamps[i].position - place.position;
      const double r2 = std::max(0.01, way.squaredNorm());
      addSource(way / std::sqrt(r2),
                light.lamps[i].power * (direct[i + 1] / static_cast<float>(r2)));
    }
  if (material.gloss > 0) { // the sky in a smooth surface, more at grazing angles
    const auto facing =
        static_cast<float>(std::clamp(place.shade.dot(place.view), 0.0, 1.0));
    const float fresnel =
        static_cast<float>(material.gloss) * (0.05f + 0.95f * power(1 - facing, 5));
    const Vector3d mirror = 2 * place.shade.dot(place.view) * place.shade - place.view;
    const float sky = mirror.z() > 0 ? 1.0f : 0.3f;
    shine += light.sky_power * (sky * open * (material.metal ? 0.35f : fresnel));
  }
  if (material.metal)
    shine = shine.cwiseProduct(color * 1.3f);
  return color.cwiseProduct(irradiance) + shine;
}

Vector3f
skyColor(const Light& light, const Vector3d& direction)
{
  const double height = direction.z() / direction.norm();
  const auto haze = static_cast<float>(std::clamp(1 - 2.5 * height, 0.0, 1.0));
  const float level = light.sky_power.mean();
  // towards the horizon the sky loses its colour and gains light
  const Vector3f zenith = light.sky_power * 1.0f;
  const Vector3f horizon = Vector3f(1.0f, 0.98f, 0.95f) * (1.35f * level);
  return height < -0.02 ? Vector3f(light.ground_bounce)
                        : Vector3f(zenith + (horizon - zenith) * haze);
}

} // namespace simulation
} // namespace hoist
