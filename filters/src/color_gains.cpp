#include <hoist/filters/color_gains.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace hoist {
namespace {

struct Uv { // CIE 1960
  double u, v;
};

// Of an sRGB colour in [0, 255], IEC 61966-2-1.
Uv
chromaticity(const std::array<double, 3>& rgb)
{
  std::array<double, 3> linear{};
  for (int c = 0; c < 3; ++c) {
    const double value = rgb[c] / 255;
    linear[c] =
        value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
  }
  const auto [r, g, b] = linear;
  const double x = 0.4124 * r + 0.3576 * g + 0.1805 * b;
  const double y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
  const double z = 0.0193 * r + 0.1192 * g + 0.9505 * b;
  const double sum = x + 15 * y + 3 * z;
  return {4 * x / sum, 6 * y / sum};
}

// Of a black body of t kelvin, 1000 to 15000: Krystek, "An algorithm to calculate
// correlated colour temperature", 1985; good to 1e-4.
Uv
planckian(double t)
{
  return {(0.860117757 + 1.54118254e-4 * t + 1.28641212e-7 * t * t) /
              (1 + 8.42420235e-4 * t + 7.08145163e-7 * t * t),
          (0.317398726 + 4.22806245e-5 * t + 4.20481691e-8 * t * t) /
              (1 - 2.89741816e-5 * t + 1.61456053e-7 * t * t)};
}

} // namespace

double
tintOfLight(const std::array<double, 3>& rgb)
{
  const Uv light = chromaticity(rgb);
  // even steps of the reciprocal temperature are about even steps on the locus
  constexpr int steps = 200;
  constexpr double coolest = 1e6 / 15000, warmest = 1e6 / 2000; // [1 / MK]
  double tint = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= steps; ++i) {
    const Uv body = planckian(1e6 / (coolest + (warmest - coolest) * i / steps));
    tint = std::min(tint, std::hypot(light.u - body.u, light.v - body.v));
  }
  return tint;
}

double
ColorHistogram::mean(int channel) const
{
  double sum = 0;
  for (int value = 0; value < 256; ++value)
    sum += static_cast<double>(counts_[channel][value]) * value;
  return sum / static_cast<double>(size_);
}

double
ColorHistogram::quantile(int channel, double share) const
{
  const double wanted = share * static_cast<double>(size_);
  double seen = 0;
  int last = 0; // highest value that occurs
  for (int value = 0; value < 256; ++value) {
    const double count = static_cast<double>(counts_[channel][value]);
    if (count <= 0)
      continue;
    last = value;
    if (seen + count >= wanted)
      return value - 0.5 + (wanted - seen) / count;
    seen += count;
  }
  return last;
}

ColorGains
estimateGains(const ColorHistogram& histogram, const WhiteBalanceParameters& parameters)
{
  if (!(parameters.percentile > 0 && parameters.percentile <= 100))
    throw std::invalid_argument("hoist::WhiteBalance: percentile must be in (0, 100]");
  if (!(parameters.max_gain >= 1))
    throw std::invalid_argument("hoist::WhiteBalance: max_gain must be >= 1");
  if (!(parameters.max_tint >= 0))
    throw std::invalid_argument("hoist::WhiteBalance: max_tint must be >= 0");
  ColorGains gains;
  if (histogram.size() == 0)
    return gains;
  std::array<double, 3> light{};
  for (int c = 0; c < 3; ++c)
    light[c] = parameters.method == WhiteBalanceMethod::grey_world
                   ? histogram.mean(c)
                   : histogram.quantile(c, parameters.percentile / 100);
  if (*std::min_element(light.begin(), light.end()) < 0.5)
    return gains; // a channel is black: there is no ratio to learn
  if (tintOfLight(light) > parameters.max_tint)
    return gains; // no light looks like that: it is the colour of what fills the scene
  const double brightest = *std::max_element(light.begin(), light.end());
  const auto gain = [&](int c) {
    return std::min(brightest / light[c], parameters.max_gain);
  };
  return {gain(0), gain(1), gain(2), true};
}

ColorGains
estimateGains(const cv::Mat3b& bgr,
              const cv::Mat1b& mask,
              const WhiteBalanceParameters& parameters)
{
  if (!mask.empty() && mask.size() != bgr.size())
    throw std::invalid_argument("hoist::WhiteBalance: mask and image differ in size");
  ColorHistogram histogram(parameters);
  for (int v = 0; v < bgr.rows; ++v)
    for (int u = 0; u < bgr.cols; ++u)
      if (mask.empty() || mask(v, u) != 0) {
        const cv::Vec3b& p = bgr(v, u);
        histogram.add(p[2], p[1], p[0]);
      }
  return estimateGains(histogram, parameters);
}

std::array<std::array<std::uint8_t, 256>, 3>
gainTables(const ColorGains& gains)
{
  std::array<std::array<std::uint8_t, 256>, 3> tables{};
  const std::array<double, 3> factors = {gains.r, gains.g, gains.b};
  for (int c = 0; c < 3; ++c)
    for (int value = 0; value < 256; ++value)
      tables[c][value] =
          static_cast<std::uint8_t>(std::min(255.0, std::round(factors[c] * value)));
  return tables;
}

void
applyGains(const ColorGains& gains, cv::Mat3b& bgr)
{
  const auto tables = gainTables(gains);
  for (int v = 0; v < bgr.rows; ++v)
    for (int u = 0; u < bgr.cols; ++u) {
      cv::Vec3b& p = bgr(v, u);
      p = {tables[2][p[0]], tables[1][p[1]], tables[0][p[2]]};
    }
}

} // namespace hoist
