#include "site.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace hoist {
namespace simulation {
namespace {

std::string
padded(int number)
{
  const std::string digits = std::to_string(number);
  return std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits;
}

// From an evening's orange to white.
Eigen::Vector3f
sunColor(double elevation)
{
  const auto low = static_cast<float>(std::clamp(1 - elevation / 30, 0.0, 1.0));
  return {1.0f, 0.96f - 0.22f * low, 0.9f - 0.45f * low};
}

void
lightUp(const Description& d, std::uint64_t seed, Scene& scene)
{
  Random random(subSeed(seed, "light"));
  Light& light = scene.light;
  const bool shines = random.chance(d.sun);
  const double elevation = d.sun_elevation.draw(random);
  const double azimuth = random.uniform();
  const double up = elevation * degree;
  light.sun = {cosineOfTurns(up) * cosineOfTurns(azimuth),
               cosineOfTurns(up) * sineOfTurns(azimuth),
               sineOfTurns(up)};
  const double sun_power = d.sun_power.draw(random);
  const auto sky = static_cast<float>(d.sky_power.draw(random));
  // a clear sky is blue, an overcast one is not
  light.sky_power = shines ? Eigen::Vector3f(0.82f, 0.95f, 1.2f) * sky
                           : Eigen::Vector3f(0.97f, 1.0f, 1.03f) * sky;
  if (shines)
    light.sun_power = sunColor(elevation) * static_cast<float>(sun_power);
  const int lamps = d.lamps.drawWhole(random);
  for (int i = 0; i < lamps; ++i) {
    Lamp lamp;
    lamp.position = {d.area[0] * random.uniform(-0.5, 0.5),
                     d.area[1] * random.uniform(-0.5, 0.5),
                     scene.support_height * 0.5 + d.lamp_height.draw(random)};
    const auto warm = static_cast<float>(random.uniform(0, 1));
    lamp.power = Eigen::Vector3f(1.0f, 0.95f - 0.1f * warm, 0.9f - 0.3f * warm) *
                 static_cast<float>(d.lamp_power.draw(random));
    light.lamps.push_back(lamp);
  }
  // what the ground sends back up
  const Eigen::Vector3f ground = linear(scene.things.front().materials.front().color);
  Eigen::Vector3f falling =
      light.sky_power + light.sun_power * static_cast<float>(light.sun.z());
  for (const Lamp& lamp : light.lamps)
    falling +=
        lamp.power / static_cast<float>(4 + lamp.position.z() * lamp.position.z());
  light.ground_bounce = ground.cwiseProduct(falling) * 0.7f;
}

// What the camera looks at: a thing, or the middle of the area.
Eigen::Vector3d
drawTarget(const Scene& scene, Random& random)
{
  std::vector<Eigen::Vector3d> centers;
  for (const Thing& thing : scene.things)
    if (thing.annotated && !thing.minor)
      centers.push_back(thing.center());
  if (centers.empty())
    return {0, 0, scene.support_height};
  return random.pick(centers);
}

// Shortens the way from the target to the eye so that the eye stays in the room.
double
insideRoom(const Description& d,
           const Eigen::Vector3d& target,
           const Eigen::Vector3d& way,
           double distance)
{
  if (!d.walls || d.walls->high == 0)
    return distance;
  for (int i = 0; i < 2; ++i) {
    const double limit =
        d.area[static_cast<std::size_t>(i)] / 2 + d.wall_distance - 0.15;
    const double room = (way[i] > 0 ? limit : -limit) - target[i];
    if (std::abs(way[i]) > 1e-9 && room / way[i] > 0)
      distance = std::min(distance, room / way[i]);
  }
  return distance;
}

void
aim(const Description& d, const Site& site, std::uint64_t seed, Scene& scene)
{
  Random random(subSeed(seed, "camera"));
  if (d.eye) {
    scene.sensor_to_world =
        lookAt(*d.eye, *d.target, d.roll.low == d.roll.high ? d.roll.low * degree : 0);
    return;
  }
  for (int attempt = 0; attempt < 50; ++attempt) {
    Eigen::Vector3d target = drawTarget(scene, random);
    const double elevation = d.elevation.draw(random) * degree;
    const double azimuth = d.azimuth.draw(random) * degree;
    const Eigen::Vector3d way(cosineOfTurns(elevation) * cosineOfTurns(azimuth),
                              cosineOfTurns(elevation) * sineOfTurns(azimuth),
                              sineOfTurns(elevation));
    const double distance = insideRoom(d, target, way, d.distance.draw(random));
    const Eigen::Vector3d eye = target + distance * way;
    for (int i = 0; i < 3; ++i)
      target[i] +=
          0.5 * d.target_jitter * distance * random.uniform(-1, 1) * (i == 2 ? 0.4 : 1);
    scene.sensor_to_world = lookAt(eye, target, d.roll.draw(random) * degree);
    if (eye.z() > 0.15 && distance > 0.5 * d.distance.low && site.free(eye))
      return;
  }
}

// A robot's way around the site: what it looks at runs ahead on the other side.
void
follow(const Description& d, const Site& site, std::uint64_t seed, Scene& scene)
{
  Random random(subSeed(seed, "way", static_cast<std::uint64_t>(scene.visit)));
  const double start = random.uniform();
  const double distance = d.distance.draw(random);
  const double elevation = d.elevation.draw(random) * degree;
  const double share = static_cast<double>(scene.index) / d.frames_per_visit;
  for (int attempt = 0; attempt < 8; ++attempt) {
    // out of the way of things: a little further out each time
    const double turn = start + share;
    const double far = distance * (1 + 0.15 * attempt);
    const Eigen::Vector3d target(0.2 * d.area[0] * cosineOfTurns(2 * turn),
                                 0.2 * d.area[1] * sineOfTurns(2 * turn),
                                 scene.support_height + 0.3);
    const Eigen::Vector3d way(cosineOfTurns(elevation) * cosineOfTurns(turn),
                              cosineOfTurns(elevation) * sineOfTurns(turn),
                              sineOfTurns(elevation));
    const Eigen::Vector3d eye = target + insideRoom(d, target, way, far) * way;
    scene.sensor_to_world = lookAt(eye, target, 0);
    if (site.free(eye))
      return;
  }
}

void
disturb(const Description& d, std::uint64_t seed, Scene& scene)
{
  Random random(subSeed(seed, "sensor"));
  Sensor& sensor = scene.sensor;
  sensor.exposure_error = d.exposure.draw(random);
  for (double& gain : sensor.white_balance_gain)
    gain = 1 + d.white_balance_error * random.uniform(-1, 1);
  for (int i = 0; i < 3; ++i) {
    sensor.registration_shift[i] += d.registration_error * random.uniform(-1, 1);
    sensor.registration_turn[i] +=
        d.registration_turn_error * 0.017453292519943295 * random.uniform(-1, 1);
  }
}

struct Place {
  std::uint64_t site_seed;
  int visit = 0; ///< from 0
  int index = 0;
};

Place
placeOfFrame(const Description& d, std::uint64_t seed, int number)
{
  Place place{};
  if (d.visits == 0) {
    place.site_seed = subSeed(seed, "scene", static_cast<std::uint64_t>(number));
    return place;
  }
  const int per_site = d.visits * d.frames_per_visit;
  place.site_seed =
      subSeed(seed, "scene", static_cast<std::uint64_t>(number / per_site));
  place.visit = number % per_site / d.frames_per_visit;
  place.index = number % d.frames_per_visit;
  return place;
}

} // namespace

std::string
frameName(const Description& description, int number)
{
  return description.name + "-" + padded(number);
}

std::uint64_t
frameSeed(std::uint64_t seed, int number)
{
  return subSeed(seed, "frame", static_cast<std::uint64_t>(number));
}

Scene
makeScene(const Description& description, std::uint64_t seed, int number)
{
  const Place place = placeOfFrame(description, seed, number);
  Site site(description, place.site_seed);
  for (int visit = 1; visit <= place.visit; ++visit)
    site.revisit(visit);
  Scene scene = site.scene();
  scene.name = frameName(description, number);
  scene.sensor = description.sensor;
  scene.seed = frameSeed(seed, number);
  if (description.visits == 0) {
    lightUp(description, place.site_seed, scene);
    aim(description, site, place.site_seed, scene);
  }
  else {
    scene.sequence =
        description.name + "-" +
        std::to_string(number / (description.visits * description.frames_per_visit));
    scene.visit = place.visit + 1;
    scene.index = place.index;
    scene.time = place.index * 1.0; // a frame a second
    lightUp(description,
            subSeed(place.site_seed, "day", static_cast<std::uint64_t>(place.visit)),
            scene);
    follow(description, site, place.site_seed, scene);
  }
  disturb(description, scene.seed, scene);
  return scene;
}

std::string
plannedSite(const Description& description, std::uint64_t seed, int number)
{
  // as planned: what stood there before anybody moved anything
  const Place place = placeOfFrame(description, seed, number);
  const Site site(description, place.site_seed);
  nlohmann::ordered_json out;
  out["site"] = description.name;
  out["seed"] = place.site_seed;
  out["elements"] = nlohmann::ordered_json::array();
  for (const Thing& thing : site.scene().things) {
    if (thing.kind == "ground" || (!thing.is_cuboid && thing.kind != "wall"))
      continue;
    const Eigen::Vector3d center = thing.center();
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (int i = 0; i < 3; ++i)
      rows.push_back({thing.axes()(i, 0), thing.axes()(i, 1), thing.axes()(i, 2)});
    out["elements"].push_back(
        {{"name", thing.name},
         {"kind", thing.kind},
         {"label", thing.label},
         {"material", thing.substance},
         {"center", {center.x(), center.y(), center.z()}},
         {"size", {thing.box_size.x(), thing.box_size.y(), thing.box_size.z()}},
         {"rotation", rows}});
  }
  return out.dump(1) + "\n";
}

} // namespace simulation
} // namespace hoist
