#include "texture.h"

#include "random.h"

#include <algorithm>
#include <cmath>

namespace hoist {
namespace samples {
namespace {

// Smooth noise in [0, 1) on a unit lattice.
double
valueNoise(double x, double y, std::uint64_t seed)
{
  const double fx = std::floor(x), fy = std::floor(y);
  const auto ix = static_cast<std::int64_t>(fx), iy = static_cast<std::int64_t>(fy);
  const auto smooth = [](double a) { return a * a * (3 - 2 * a); };
  const double a = smooth(x - fx), b = smooth(y - fy);
  const double top = hash01(seed, ix, iy) * (1 - a) + hash01(seed, ix + 1, iy) * a;
  const double low =
      hash01(seed, ix, iy + 1) * (1 - a) + hash01(seed, ix + 1, iy + 1) * a;
  return top * (1 - b) + low * b;
}

double
fractalNoise(double x, double y, std::uint64_t seed)
{
  return 0.5 * valueNoise(x, y, seed) + 0.3 * valueNoise(2.1 * x, 2.1 * y, seed + 1) +
         0.2 * valueNoise(4.3 * x, 4.3 * y, seed + 2);
}

double
modulo(double a, double b)
{
  return a - b * std::floor(a / b);
}

// A carton: a bright panel, a disc on it, and lines of text below.
Eigen::Vector3d
print(const Eigen::Vector3d& base,
      double s,
      double t,
      const Eigen::Vector2d& half,
      std::uint64_t seed)
{
  const Eigen::Vector3d ink(
      200 * hash01(seed, 11), 200 * hash01(seed, 12), 200 * hash01(seed, 13));
  const Eigen::Vector3d paper = 0.3 * base + 0.7 * Eigen::Vector3d::Constant(245);
  const double a = s / half.x(), b = t / half.y(); // [-1, 1] over the face
  if (std::max(std::abs(a), std::abs(b)) > 0.86)
    return base;
  const double ds = a - (hash01(seed, 1) - 0.5), dt = b + 0.35;
  const double scale = std::min(half.x(), half.y());
  const double r2 =
      (ds * ds * half.x() * half.x() + dt * dt * half.y() * half.y()) / (scale * scale);
  if (r2 < 0.2)
    return r2 < 0.08 ? paper : ink;
  if (b > 0.15) {
    // words of random width on lines 12 mm apart, 6 mm high
    const double line = std::floor(t / 0.012);
    const auto row = static_cast<std::int64_t>(line);
    if (t - line * 0.012 < 0.006) {
      const auto word = static_cast<std::int64_t>(std::floor(s / 0.009));
      if (hash01(seed, 21, row, word) > 0.3)
        return ink * 0.6;
    }
    return paper;
  }
  return base * 0.8 + paper * 0.2;
}

Eigen::Vector3d
wood(const Eigen::Vector3d& base,
     double s,
     double t,
     const Eigen::Vector2d& half,
     std::uint64_t seed)
{
  // planks run along the longer side
  if (half.y() > half.x())
    std::swap(s, t);
  constexpr double plank_width = 0.09; // [m]
  const auto plank = static_cast<std::int64_t>(std::floor(t / plank_width));
  if (modulo(t, plank_width) < 0.003)
    return base * 0.35;
  const double grain =
      fractalNoise(s * 8, t * 160, seed + static_cast<unsigned>(plank));
  const double tone = 0.8 + 0.2 * hash01(seed, 31, plank);
  return base * (tone * (0.75 + 0.4 * grain));
}

Eigen::Vector3d
concrete(const Eigen::Vector3d& base, double s, double t, std::uint64_t seed)
{
  const double blotch = fractalNoise(s * 25, t * 25, seed);
  const double pit = valueNoise(s * 150, t * 150, seed + 9);
  return base * ((0.8 + 0.3 * blotch) * (pit > 0.93 ? 0.6 : 1.0));
}

} // namespace

Eigen::Vector3d
albedo(Texture texture,
       const Rgb& base,
       double s,
       double t,
       const Eigen::Vector2d& half,
       std::uint64_t seed)
{
  const Eigen::Vector3d color(base[0], base[1], base[2]);
  Eigen::Vector3d out = color;
  switch (texture) {
  case Texture::plain:
    break;
  case Texture::print:
    if (std::isfinite(half.x()) && std::isfinite(half.y()))
      out = print(color, s, t, half, seed);
    break;
  case Texture::wood:
    out = wood(color, s, t, half, seed);
    break;
  case Texture::concrete:
    out = concrete(color, s, t, seed);
    break;
  case Texture::stripes:
    out = modulo(s + t, 0.08) < 0.04 ? color : Eigen::Vector3d(color * 0.45);
    break;
  }
  return out.cwiseMin(255.0).cwiseMax(0.0);
}

} // namespace samples
} // namespace hoist
