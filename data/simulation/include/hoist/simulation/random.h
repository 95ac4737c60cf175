#pragma once

#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

namespace hoist {
namespace simulation {

/** \brief Mixes 64 bits (the finaliser of splitmix64, Steele et al. 2014). */
inline std::uint64_t
mix(std::uint64_t x)
{
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/** \brief A seed of its own for a purpose, so that one draw more there changes nothing
 *  elsewhere. */
inline std::uint64_t
subSeed(std::uint64_t seed, std::string_view purpose, std::uint64_t number = 0)
{
  std::uint64_t h = mix(seed ^ 0x5851f42d4c957f2dULL);
  for (const char c : purpose)
    h = mix(h ^ static_cast<unsigned char>(c));
  return mix(h ^ (number * 0x9e3779b97f4a7c15ULL));
}

/** \brief A number in [0, 1) that depends on nothing but its arguments. */
inline double
hash01(std::uint64_t seed, std::int64_t a, std::int64_t b = 0, std::int64_t c = 0)
{
  const std::uint64_t h = mix(mix(seed ^ static_cast<std::uint64_t>(a)) ^
                              (static_cast<std::uint64_t>(b) * 0x9e3779b97f4a7c15ULL) ^
                              (static_cast<std::uint64_t>(c) * 0xc2b2ae3d27d4eb4fULL));
  return static_cast<double>(h >> 11) * 0x1.0p-53;
}

/** \brief Nearly normal, mean 0, variance 1, |x| <= 6: twelve uniform numbers of 16
 * bits added up. Only sums are used, so that every platform gives the same bits. */
inline double
hashNormal(std::uint64_t seed, std::int64_t a, std::int64_t b = 0)
{
  std::uint64_t h = mix(mix(seed ^ static_cast<std::uint64_t>(a)) ^
                        (static_cast<std::uint64_t>(b) * 0x9e3779b97f4a7c15ULL));
  std::int64_t sum = 0;
  for (int i = 0; i < 3; ++i, h = mix(h))
    for (int k = 0; k < 4; ++k)
      sum += static_cast<std::int64_t>(h >> (16 * k) & 0xffff);
  return static_cast<double>(sum) / 65535.0 - 6.0;
}

constexpr double degree = 1.0 / 360; ///< [turns]

/** \brief Sine of an angle in turns (1 is the full circle), to 1e-9.
 *
 * The C library's differs in the last bit from one processor to the next; a scene must
 * not. Taylor's series on an eighth of the circle.
 */
double sineOfTurns(double turns);

inline double
cosineOfTurns(double turns)
{
  return sineOfTurns(turns + 0.25);
}

/** \brief A small generator of reproducible numbers; std's distributions differ from
 *  one standard library to the next. */
class Random {
public:
  explicit Random(std::uint64_t seed) : state_(mix(seed)) {}

  std::uint64_t
  bits()
  {
    state_ += 0x9e3779b97f4a7c15ULL;
    return mix(state_);
  }

  /** \brief In [0, 1). */
  double
  uniform()
  {
    return static_cast<double>(bits() >> 11) * 0x1.0p-53;
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

  bool
  chance(double probability)
  {
    return uniform() < probability;
  }

  /** \brief One of a list that is not empty. */
  template <typename T>
  const T&
  pick(const std::vector<T>& list)
  {
    return list[static_cast<std::size_t>(index(static_cast<int>(list.size())))];
  }

private:
  std::uint64_t state_;
};

} // namespace simulation
} // namespace hoist
