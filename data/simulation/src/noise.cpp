#include "noise.h"

#include <hoist/simulation/random.h>

#include <algorithm>
#include <cmath>

namespace hoist {
namespace simulation {

double
latticeNoise(const Eigen::Vector3d& p, std::uint64_t seed)
{
  const double fx = std::floor(p.x()), fy = std::floor(p.y()), fz = std::floor(p.z());
  const auto ix = static_cast<std::int64_t>(fx), iy = static_cast<std::int64_t>(fy),
             iz = static_cast<std::int64_t>(fz);
  const auto smooth = [](double a) { return a * a * (3 - 2 * a); };
  const double a = smooth(p.x() - fx), b = smooth(p.y() - fy), c = smooth(p.z() - fz);
  // one hash gives the four corners of a side: 16 bits each
  double side[2][4];
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i) {
        std::uint64_t h = seed ^
                          (static_cast<std::uint64_t>(ix + i) * 0x9e3779b97f4a7c15ULL) ^
                          (static_cast<std::uint64_t>(iy + j) * 0xc2b2ae3d27d4eb4fULL) ^
                          (static_cast<std::uint64_t>(iz + k) * 0x165667b19e3779f9ULL);
        h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93ULL;
        h ^= h >> 32;
        side[k][2 * j + i] = static_cast<double>(h >> 40 & 0xffff) * (1.0 / 65536);
      }
  const auto mixed = [&](const double* s) {
    const double low = s[0] + (s[1] - s[0]) * a, high = s[2] + (s[3] - s[2]) * a;
    return low + (high - low) * b;
  };
  const double near = mixed(side[0]), far = mixed(side[1]);
  return near + (far - near) * c;
}

double
visible(double size, double footprint)
{
  return std::clamp(size / (2 * footprint + 1e-9) - 0.5, 0.0, 1.0);
}

double
fractalNoise(const Eigen::Vector3d& p,
             double size,
             int octaves,
             double footprint,
             std::uint64_t seed)
{
  double sum = 0.5, height = 0.6;
  for (int i = 0; i < octaves; ++i) {
    const double share = visible(size, footprint);
    if (share <= 0)
      break;
    sum += share * height *
           (latticeNoise(p / size, seed + static_cast<unsigned>(i)) - 0.5);
    size *= 0.47; // no two lattices fall together
    height *= 0.7;
  }
  return sum;
}

} // namespace simulation
} // namespace hoist
