#include "noise.h"

#include <hoist/simulation/random.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace hoist {
namespace simulation {

namespace {

// The C library's floor is a call where the processor's own may not be used (SSE2).
std::int64_t
floorOf(double x)
{
  const auto whole = static_cast<std::int64_t>(x);
  return whole - (x < static_cast<double>(whole) ? 1 : 0);
}

constexpr std::size_t numbers = 4096;

// The middles of as many equal parts of [0, 1], shuffled: mean 1/2, evenly spread.
constexpr std::array<float, numbers>
shuffled()
{
  std::array<float, numbers> list{};
  for (std::size_t i = 0; i < numbers; ++i)
    list[i] = (static_cast<float>(i) + 0.5f) / numbers;
  std::uint64_t state = 1;
  for (std::size_t i = numbers - 1; i > 0; --i) {
    // Knuth's generator of 64 bits; its upper bits are good
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    const std::size_t j = (state >> 33) % (i + 1);
    const float other = list[j];
    list[j] = list[i];
    list[i] = other;
  }
  return list;
}

constexpr std::array<float, numbers> lattice = shuffled();

} // namespace

double
latticeNoise(const Eigen::Vector3d& p, std::uint64_t seed)
{
  const std::int64_t ix = floorOf(p.x()), iy = floorOf(p.y()), iz = floorOf(p.z());
  const auto smooth = [](double a) { return a * a * (3 - 2 * a); };
  const double a = smooth(p.x() - static_cast<double>(ix)),
               b = smooth(p.y() - static_cast<double>(iy)),
               c = smooth(p.z() - static_cast<double>(iz));
  double rows[4]; // between the two corners of every row along x
  for (unsigned k = 0; k < 2; ++k)
    for (unsigned j = 0; j < 2; ++j) {
      // every row of the lattice starts somewhere else in the list
      std::uint64_t h = seed ^
                        (static_cast<std::uint64_t>(iy) + j) * 0xc2b2ae3d27d4eb4fULL ^
                        (static_cast<std::uint64_t>(iz) + k) * 0x165667b19e3779f9ULL;
      h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93ULL;
      h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93ULL;
      const std::uint64_t start = (h >> 40) + static_cast<std::uint64_t>(ix);
      const double low = lattice[start % numbers],
                   high = lattice[(start + 1) % numbers];
      rows[2 * k + j] = low + (high - low) * a;
    }
  const double near = rows[0] + (rows[1] - rows[0]) * b,
               far = rows[2] + (rows[3] - rows[2]) * b;
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
