#include <hoist/simulation/random.h>

namespace hoist {
namespace simulation {

double
sineOfTurns(double turns)
{
  constexpr double two_pi = 6.283185307179586;
  const double t = turns - std::floor(turns); // [0, 1)
  const auto quarter = static_cast<int>(t * 4.0);
  double x = (t - 0.25 * quarter); // [0, 1/4) turns
  // sine or cosine of at most an eighth of the circle
  const bool far = x > 0.125;
  if (far)
    x = 0.25 - x;
  const double a = two_pi * x, a2 = a * a;
  const double s =
      a * (1 - a2 / 6 * (1 - a2 / 20 * (1 - a2 / 42 * (1 - a2 / 72 * (1 - a2 / 110)))));
  const double c =
      1 - a2 / 2 *
              (1 - a2 / 12 *
                       (1 - a2 / 30 * (1 - a2 / 56 * (1 - a2 / 90 * (1 - a2 / 132)))));
  switch (quarter & 3) {
  case 0:
    return far ? c : s;
  case 1:
    return far ? s : c;
  case 2:
    return far ? -c : -s;
  default:
    return far ? -s : -c;
  }
}

} // namespace simulation
} // namespace hoist
