#pragma once

#include <cstdint>

namespace hoist {
namespace samples {

/** \brief Mixes 64 bits (the finaliser of splitmix64, Steele et al. 2014). */
inline std::uint64_t
mix(std::uint64_t x)
{
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/** \brief A number in [0, 1) that depends on nothing but its arguments. */
inline double
hash01(std::uint64_t seed, std::int64_t a, std::int64_t b = 0, std::int64_t c = 0)
{
  const std::uint64_t h = mix(mix(mix(seed ^ static_cast<std::uint64_t>(a)) ^
                                  (static_cast<std::uint64_t>(b) * 0x9e3779b1ULL)) ^
                              (static_cast<std::uint64_t>(c) * 0x85ebca77ULL));
  return static_cast<double>(h >> 11) * 0x1.0p-53;
}

/** \brief Nearly normal, mean 0, variance 1: twelve uniform numbers added up. Only sums
 *  are used, so that every platform gives the same bits. */
inline double
hashNormal(std::uint64_t seed, std::int64_t a, std::int64_t b = 0, std::int64_t c = 0)
{
  // each 64 bit hash gives four 16 bit uniform numbers
  std::uint64_t h = mix(mix(mix(seed ^ static_cast<std::uint64_t>(a)) ^
                            (static_cast<std::uint64_t>(b) * 0x9e3779b1ULL)) ^
                        (static_cast<std::uint64_t>(c) * 0x85ebca77ULL));
  std::int64_t sum = 0;
  for (int i = 0; i < 3; ++i, h = mix(h))
    for (int k = 0; k < 4; ++k)
      sum += static_cast<std::int64_t>(h >> (16 * k) & 0xffff);
  return static_cast<double>(sum) / 65535.0 - 6.0;
}

/** \brief A small generator of reproducible numbers; std's distributions differ from
 *  one standard library to the next. */
class Random {
public:
  explicit Random(std::uint64_t seed) : state_(mix(seed)) {}

  /** \brief In [0, 1). */
  double
  uniform()
  {
    state_ += 0x9e3779b97f4a7c15ULL;
    return static_cast<double>(mix(state_) >> 11) * 0x1.0p-53;
  }

  /** \brief In [low, high). */
  double
  uniform(double low, double high)
  {
    return low + (high - low) * uniform();
  }

  /** \brief In {0, ..., n - 1}, n > 0. */
  int
  index(int n)
  {
    return static_cast<int>(uniform() * n);
  }

  /** \brief Nearly normal, mean 0, variance 1. */
  double
  normal()
  {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i)
      sum += uniform();
    return sum;
  }

private:
  std::uint64_t state_;
};

} // namespace samples
} // namespace hoist
