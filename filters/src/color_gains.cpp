#include <hoist/filters/color_gains.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hoist {

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
  const double luma = 0.299 * light[0] + 0.587 * light[1] + 0.114 * light[2];
  const auto gain = [&](int c) {
    return std::clamp(luma / light[c], 1 / parameters.max_gain, parameters.max_gain);
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
