#include "achromatic.h"

#include <hoist/recognition/color.h>

#include <algorithm>
#include <cmath>

namespace hoist {
namespace {

constexpr double pi = 3.14159265358979323846;

const char*
greyName(double lightness)
{
  if (lightness > 80.0)
    return "white";
  return lightness < 22.0 ? "black" : "grey";
}

// Hue 345 to 50 degrees.
const char*
redName(double lightness, double chroma, double hue)
{
  if (lightness > 62.0 || (lightness > 45.0 && hue >= 345.0))
    return "pink";
  // a dark red has less chroma than a light one
  const bool dull = chroma < std::min(35.0, 0.8 * lightness);
  return dull && hue > 15.0 && hue < 345.0 ? "brown" : "red";
}

// Hue 87 to 109 degrees. Dark yellow is brown, or olive, which counts as green.
const char*
yellowName(double lightness, double chroma, double hue)
{
  if (lightness >= 65.0)
    return chroma >= 25.0 || hue >= 95.0 ? "yellow" : "brown";
  if (lightness >= 54.0 && chroma >= 30.0 && hue < 104.0)
    return "yellow";
  return hue < 98.0 ? "brown" : "green";
}

} // namespace

double
leastChroma(double lightness, double hue)
{
  const double blueness = std::max(0.0, std::cos((hue - 260.0) * pi / 180.0));
  const double shade = std::clamp((lightness + 10.0) / 50.0, 0.4, 1.0);
  const double noise = std::clamp(30.0 - lightness, 0.0, 20.0);
  return std::max((12.0 + 5.0 * blueness) * shade, noise);
}

std::string
colorName(const std::array<double, 3>& lab, double white)
{
  const double lightness = lab[0] * 100.0 / white;
  const double chroma = std::hypot(lab[1], lab[2]);
  double hue = std::atan2(lab[2], lab[1]) * 180.0 / pi;
  if (hue < 0)
    hue += 360.0;

  const bool nearly_white = lightness > 90.0 && chroma < 20.0;
  if (nearly_white || chroma < leastChroma(lightness, hue))
    return greyName(lightness);
  if (hue < 50.0 || hue >= 345.0)
    return redName(lightness, chroma, hue);
  if (hue < 87.0) // dark or dull orange is brown
    return lightness >= 50.0 && chroma >= 42.0 ? "orange" : "brown";
  if (hue < 109.0)
    return yellowName(lightness, chroma, hue);
  if (hue < 200.0)
    return "green";
  if (hue < 310.0)
    return hue >= 300.0 && lightness > 45.0 && chroma < 80.0 ? "purple" : "blue";
  if (hue < 332.0 || lightness < 45.0)
    return "purple";
  return "pink";
}

} // namespace hoist
