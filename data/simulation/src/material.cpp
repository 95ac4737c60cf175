#include <hoist/simulation/material.h>

#include "noise.h"
#include <hoist/simulation/random.h>

#include <algorithm>
#include <cmath>

namespace hoist {
namespace simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

struct SrgbTables {
  std::array<float, 256> decode{};
  std::array<float, 4097> encode{};

  SrgbTables()
  {
    for (int i = 0; i < 256; ++i) {
      const double s = i / 255.0;
      decode[i] = static_cast<float>(s <= 0.04045 ? s / 12.92
                                                  : std::pow((s + 0.055) / 1.055, 2.4));
    }
    // by the square root of the value: evenly fine in the dark
    for (int i = 0; i <= 4096; ++i) {
      const double root = i / 4096.0, l = root * root;
      encode[i] = static_cast<float>(
          l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1 / 2.4) - 0.055);
    }
  }
};

const SrgbTables&
tables()
{
  static const SrgbTables all;
  return all;
}

double
modulo(double a, double b)
{
  return a - b * std::floor(a / b);
}

// What a pattern makes of the base colour: a tone around 1 and a share of the second.
struct Pattern {
  double tone = 1;
  double second = 0;
};

// The side of the box that a normal points to, and the place on it.
struct OnSide {
  int axis;
  int number; ///< 0..5
  Vector2d
      place; ///< [m] from the side's middle; second coordinate upwards if it can be
  Vector2d half;
};

OnSide
onSide(const Vector3d& p, const Vector3d& n, const Vector3d& half)
{
  OnSide side{};
  n.cwiseAbs().maxCoeff(&side.axis);
  side.number = 2 * side.axis + (n[side.axis] < 0 ? 1 : 0);
  const int u = side.axis == 0 ? 1 : 0, v = side.axis == 2 ? 1 : 2;
  side.place = {p[u], p[v]};
  side.half = {half[u], half[v]};
  return side;
}

Pattern
concrete(const Material& m, const Vector3d& p, double footprint)
{
  Pattern out;
  const double blotch = fractalNoise(p, 0.35 * m.scale, 5, footprint, m.seed);
  const double grain = fractalNoise(p, 0.012 * m.scale, 2, footprint, m.seed + 40);
  out.tone += 0.45 * (blotch - 0.5) + 0.4 * (grain - 0.5);
  const double fine = visible(0.012, footprint);
  if (fine > 0) { // pores, where it was cast against a form
    const double pore = latticeNoise(p / (0.011 * m.scale), m.seed + 50);
    if (pore > 0.86)
      out.tone -= fine * std::min(1.0, (pore - 0.86) * 12) * 0.45;
  }
  return out;
}

Pattern
wood(const Material& m, const Vector3d& p, const OnSide& side, double footprint)
{
  Pattern out;
  const bool upright = side.half.y() > side.half.x();
  const double along = upright ? side.place.y() : side.place.x();
  const double across = upright ? side.place.x() : side.place.y();
  const double width = 0.1 * m.scale;
  const double board = std::floor(across / width);
  const auto number = static_cast<std::int64_t>(board) + 64 * side.number;
  const std::uint64_t seed = m.seed + static_cast<std::uint64_t>(number);
  out.tone = 0.85 + 0.3 * hash01(m.seed, number, 1);
  const Vector3d q(along / 14, across, 0.3 * p[side.axis]);
  out.tone += 0.5 * (fractalNoise(q, 0.02 * m.scale, 3, footprint, seed) - 0.5);
  const double knot =
      latticeNoise(Vector3d(along / 0.22, across / 0.07, 0.5), seed + 9);
  if (knot > 0.87)
    out.tone -= (knot - 0.87) * 4;
  const double gap = modulo(across, width);
  if (gap < 0.004)
    out.tone *= 1 - 0.7 * visible(0.006, footprint);
  return out;
}

Pattern
print(const Material& m, const OnSide& side, double footprint)
{
  Pattern out;
  const std::uint64_t seed = m.seed + (side.axis == 2 ? 7 : side.axis);
  const double s = side.place.x(), t = side.place.y();
  const double a = s / side.half.x(), b = t / side.half.y();
  // corrugation shows faintly through every carton
  out.tone += 0.04 * (modulo(s, 0.008) < 0.004 ? 1 : -1) * visible(0.008, footprint);
  if (side.axis == 2) { // lid: the joint of the flaps under tape
    const double across = side.half.x() > side.half.y() ? t : s;
    if (std::abs(across) < 0.024)
      out.tone *= 1.12;
    if (std::abs(across) < 0.0015)
      out.tone *= 0.6;
    return out;
  }
  const double least = std::min(side.half.x(), side.half.y());
  if (b > 0.25 && b < 0.62 && std::abs(a) < 0.75 && hash01(seed, 3) > 0.35) {
    const double row = std::floor(t / (0.16 * least)); // a title in large letters
    const double letter = std::floor(s / (0.11 * least));
    if (hash01(seed,
               4,
               static_cast<std::int64_t>(row),
               static_cast<std::int64_t>(letter)) > 0.35 &&
        modulo(t, 0.16 * least) < 0.11 * least &&
        modulo(s, 0.11 * least) < 0.085 * least)
      out.second = 0.85;
  }
  const double ds = s - side.half.x() * (hash01(seed, 1) - 0.5);
  const double dt = t + 0.1 * side.half.y();
  const double r = std::sqrt(ds * ds + dt * dt) / least;
  if (r < 0.28 && hash01(seed, 5) > 0.4)
    out.second = r < 0.2 && r > 0.1 ? 0.0 : 0.9;
  if (b < -0.45 && b > -0.85 && std::abs(a) < 0.8) {
    const double line = std::floor(t / 0.014), word = std::floor(s / 0.011);
    if (modulo(t, 0.014) < 0.007 && hash01(seed,
                                           21,
                                           static_cast<std::int64_t>(line),
                                           static_cast<std::int64_t>(word)) > 0.35)
      out.second = 0.75 * visible(0.012, footprint);
  }
  return out;
}

Pattern
rust(const Material& m, const Vector3d& p, double footprint)
{
  Pattern out;
  const double patch = fractalNoise(p, 0.18 * m.scale, 5, footprint, m.seed);
  const double edge = 0.62 - 0.25 * m.stains;
  out.second = std::clamp((patch - edge) * 9, 0.0, 1.0);
  out.tone += 0.25 * (fractalNoise(p, 0.02, 2, footprint, m.seed + 20) - 0.5) *
              (0.4 + out.second);
  return out;
}

Pattern
brick(const Material& m, const Vector3d& p, const OnSide& side, double footprint)
{
  Pattern out;
  const double length = 0.25 * m.scale, height = 0.075 * m.scale;
  const double t = side.place.y() + side.half.y(), course = std::floor(t / height);
  const double s =
      side.place.x() + side.half.x() + (modulo(course, 2) < 1 ? 0 : length / 2);
  const double number = std::floor(s / length);
  const double joint = 0.01 * m.scale;
  if (modulo(t, height) < joint || modulo(s, length) < joint)
    out.second = visible(joint, footprint);
  out.tone = 0.82 + 0.36 * hash01(m.seed + side.number,
                                  static_cast<std::int64_t>(course),
                                  static_cast<std::int64_t>(number));
  out.tone += 0.3 * (fractalNoise(p, 0.02, 2, footprint, m.seed) - 0.5);
  return out;
}

Pattern
patternOf(const Material& m,
          const Vector3d& p,
          const Vector3d& n,
          const Vector3d& half,
          double footprint)
{
  Pattern out;
  switch (m.texture) {
  case Texture::plain:
    break;
  case Texture::concrete:
    return concrete(m, p, footprint);
  case Texture::wood:
    return wood(m, p, onSide(p, n, half), footprint);
  case Texture::print:
    return print(m, onSide(p, n, half), footprint);
  case Texture::rust:
    return rust(m, p, footprint);
  case Texture::brick:
    return brick(m, p, onSide(p, n, half), footprint);
  case Texture::fabric: {
    const OnSide side = onSide(p, n, half);
    const double weave = ((modulo(side.place.x(), 0.004) < 0.002) !=
                          (modulo(side.place.y(), 0.004) < 0.002))
                             ? 1
                             : -1;
    out.tone += 0.08 * weave * visible(0.004, footprint) +
                0.25 * (fractalNoise(p, 0.05 * m.scale, 3, footprint, m.seed) - 0.5);
    break;
  }
  case Texture::asphalt:
    out.tone +=
        0.3 * (fractalNoise(p, 0.8 * m.scale, 6, footprint, m.seed) - 0.5) +
        0.55 * (fractalNoise(p, 0.014 * m.scale, 2, footprint, m.seed + 30) - 0.5);
    break;
  case Texture::soil:
    out.tone +=
        0.6 * (fractalNoise(p, 0.5 * m.scale, 5, footprint, m.seed) - 0.5) +
        0.5 * (fractalNoise(p, 0.03 * m.scale, 3, footprint, m.seed + 30) - 0.5);
    break;
  case Texture::plaster:
    out.tone +=
        0.12 * (fractalNoise(p, 0.6 * m.scale, 3, footprint, m.seed) - 0.5) +
        0.06 * (fractalNoise(p, 0.01 * m.scale, 1, footprint, m.seed + 30) - 0.5);
    break;
  case Texture::stripes: {
    const OnSide side = onSide(p, n, half);
    const double w = 0.12 * m.scale;
    if (modulo(side.place.x() + side.place.y(), w) < w / 2)
      out.second = 1;
    break;
  }
  case Texture::leaf:
    out.tone += 0.5 * (fractalNoise(p, 0.03 * m.scale, 3, footprint, m.seed) - 0.5);
    break;
  }
  return out;
}

} // namespace

Vector3f
linear(const Rgb& color)
{
  const auto& decode = tables().decode;
  return {decode[color[0]], decode[color[1]], decode[color[2]]};
}

float
encodeSrgb(float value)
{
  if (!(value > 0))
    return 0;
  const float x = 4096 * std::sqrt(std::min(value, 1.0f));
  const auto i = std::min(4095, static_cast<int>(x));
  const auto& encode = tables().encode;
  return encode[i] + (encode[i + 1] - encode[i]) * (x - static_cast<float>(i));
}

Vector3f
albedo(const Material& material,
       const Vector3d& p,
       const Vector3d& n,
       const Vector3d& half,
       double footprint)
{
  const Pattern pattern = patternOf(material, p, n, half, footprint);
  const double tone = 1 + material.contrast * (pattern.tone - 1);
  const auto second = static_cast<float>(pattern.second);
  Vector3f color =
      linear(material.color) * (1 - second) + linear(material.second) * second;
  color *= static_cast<float>(std::clamp(tone, 0.15, 2.0));
  if (material.stains > 0) {
    // dirt gathers in patches and towards the ground
    const double dirt = fractalNoise(p, 0.25, 4, footprint, material.seed + 77);
    const double low = std::clamp(1 - (p.z() + half.z()) / 0.15, 0.0, 1.0);
    const double share =
        std::clamp((dirt - 0.72 + 0.3 * material.stains + 0.15 * low) * 5, 0.0, 1.0) *
        material.stains * 0.75;
    const Vector3f brown(0.11f, 0.085f, 0.06f);
    color += (brown - color) * static_cast<float>(share);
  }
  return color.cwiseMin(0.95f).cwiseMax(0.0f);
}

} // namespace simulation
} // namespace hoist
