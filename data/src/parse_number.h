#pragma once

// Numbers from text: exactly rounded, whatever the locale. The text must be followed by
// a byte that belongs to no number (a line end), so that no end has to be checked.

#include <cfloat>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <system_error>

namespace hoist {
namespace detail {

inline bool
isDigit(char c)
{
  return static_cast<unsigned>(c - '0') < 10;
}

inline bool
endsNumber(char c)
{
  return c == ' ' || c == '\n' || c == '\t' || c == '\r';
}

// The general case, by the standard library; nullptr if there is no number.
template <typename Real>
inline const char*
parseSlowly(const char* p, Real& out)
{
  const char* end = p;
  while (!endsNumber(*end) && *end != '\0')
    ++end;
  if (*p == '+')
    ++p;
  const auto [stop, error] = std::from_chars(p, end, out);
  if (error == std::errc::result_out_of_range) {
    // beyond the range of a float: infinity, or zero for tiny numbers. long double
    // tells which
    long double wide = 0;
    const auto again = std::from_chars(p, end, wide);
    out = again.ec == std::errc() && std::fabs(wide) < 1
              ? Real(0)
              : Real(wide < 0 ? -HUGE_VAL : HUGE_VAL);
    return stop;
  }
  return error == std::errc() ? stop : nullptr;
}

/** \brief Reads a float or a double at \a p.
 *  \return the byte after the number; nullptr if there is none */
template <typename Real>
inline const char*
parseReal(const char* const begin, Real& out)
{
  static constexpr double powers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                      1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                      1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  const char* p = begin;
  const bool negative = *p == '-';
  p += negative || *p == '+' ? 1 : 0;
  std::uint64_t mantissa = 0;
  const char* const first = p;
  for (; isDigit(*p); ++p)
    mantissa = mantissa * 10 + static_cast<unsigned>(*p - '0');
  auto digits = p - first;
  std::ptrdiff_t decimals = 0;
  if (*p == '.') {
    const char* const point = ++p;
    for (; isDigit(*p); ++p)
      mantissa = mantissa * 10 + static_cast<unsigned>(*p - '0');
    decimals = p - point;
    digits += decimals;
  }
  // Clinger's fast path: both numbers are exact doubles, so that the quotient is
  // rounded once.
  if (digits == 0 || digits > 19 || decimals > 22 || mantissa >> 53 != 0 ||
      !endsNumber(*p))
    return parseSlowly(begin, out);
  const double value = static_cast<double>(mantissa) / powers[decimals];
  if (sizeof(Real) == sizeof(float)) {
    // Rounded a second time, to float: wrong only if the double lies just between two
    // floats, or among the subnormal ones.
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof(bits));
    if ((bits & 0x1fffffff) == 0x10000000 ||
        (value < static_cast<double>(FLT_MIN) && mantissa != 0))
      return parseSlowly(begin, out);
  }
  out = static_cast<Real>(negative ? -value : value);
  return p;
}

/** \brief Reads digits only, at most nine of them; nullptr for anything else. */
inline const char*
parseDigits(const char* p, std::uint32_t& out)
{
  const char* const first = p;
  std::uint32_t value = 0;
  for (; isDigit(*p); ++p)
    value = value * 10 + static_cast<unsigned>(*p - '0');
  if (p == first || p - first > 9 || !endsNumber(*p))
    return nullptr;
  out = value;
  return p;
}

} // namespace detail
} // namespace hoist
