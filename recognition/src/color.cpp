#include <hoist/recognition/color.h>

#include "achromatic.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace hoist {
namespace {

constexpr float hue_reach = 25.0f;       // [degrees] inks that count as one colour
constexpr float core_reach = 12.5f;      // [degrees] shades of one ink, with noise
constexpr float lightness_reach = 20.0f; // faces of one grey box in other light
constexpr int bin_width = 5;             // of both, [degrees] and [L*]
constexpr int hue_bins = 360 / bin_width;
constexpr int lightness_bins = 100 / bin_width;

// A pixel as the clusters see it.
struct Shade {
  float lightness, chroma, hue; // L*, C, [degrees] in [0, 360)
  float chromatic;              // how much of a hue it has, in [0, 1]
};

Shade
shadeOf(const cv::Vec3f& lab)
{
  Shade shade{lab[0], std::hypot(lab[1], lab[2]), 0, 0};
  shade.hue = std::atan2(lab[2], lab[1]) * static_cast<float>(180 / CV_PI);
  if (shade.hue < 0)
    shade.hue += 360.0f;
  // Noise carries pixels over the border of the greys: it is a ramp, not a step.
  const auto border = static_cast<float>(leastChroma(shade.lightness, shade.hue));
  shade.chromatic = std::clamp((shade.chroma / border - 0.6f) / 0.8f, 0.0f, 1.0f);
  return shade;
}

struct Cluster {
  double weight = 0;
  float center = 0;
};

// The heaviest window of bins with its middle among [first, last]; the first of equal
// ones.
template <std::size_t n>
Cluster
heaviest(const std::array<double, n>& histogram,
         float reach,
         int first = 0,
         int last = static_cast<int>(n) - 1)
{
  constexpr int size = static_cast<int>(n);
  const int half = static_cast<int>(reach) / bin_width;
  Cluster best;
  for (int i = first; i <= last; ++i) {
    double weight = 0;
    for (int k = i - half; k <= i + half; ++k)
      if (k >= 0 && k < size)
        weight += histogram[k];
    if (weight > best.weight)
      best = {weight, (static_cast<float>(i) + 0.5f) * bin_width};
  }
  return best;
}

// Neighbouring hues (a red carton's orange print) vote together, but the surface is the
// densest of them alone.
Cluster
largestHue(const std::vector<Shade>& shades)
{
  std::array<double, 3 * hue_bins> histogram{}; // three turns: no window wraps
  for (const Shade& s : shades)
    for (int turn = 0; turn < 3; ++turn)
      histogram[turn * hue_bins + static_cast<int>(s.hue / bin_width) % hue_bins] +=
          s.chromatic;
  const Cluster all = heaviest(histogram, hue_reach, hue_bins, 2 * hue_bins - 1);
  const int middle = static_cast<int>(all.center) / bin_width;
  constexpr int reach_bins = static_cast<int>(hue_reach) / bin_width;
  Cluster core =
      heaviest(histogram, core_reach, middle - reach_bins, middle + reach_bins);
  core.weight = all.weight;
  return core;
}

Cluster
largestGrey(const std::vector<Shade>& shades)
{
  std::array<double, lightness_bins> histogram{};
  for (const Shade& s : shades)
    histogram[std::clamp(
        static_cast<int>(s.lightness / bin_width), 0, lightness_bins - 1)] +=
        1.0 - s.chromatic;
  return heaviest(histogram, lightness_reach);
}

// Numbers of the shades in the larger cluster, and what makes them pure.
std::vector<int>
largestCluster(const std::vector<Shade>& shades, float Shade::*& purity)
{
  const Cluster hue = largestHue(shades), grey = largestGrey(shades);
  const bool chromatic = hue.weight >= grey.weight;
  purity = chromatic ? &Shade::chroma : &Shade::lightness;
  constexpr float half_bin = 0.5f * bin_width;
  std::vector<int> members;
  for (std::size_t i = 0; i < shades.size(); ++i) {
    const Shade& s = shades[i];
    float apart = std::abs(s.lightness - grey.center);
    if (chromatic)
      apart = std::abs(std::remainder(s.hue - hue.center, 360.0f));
    const float reach = (chromatic ? core_reach : lightness_reach) + half_bin;
    if ((s.chromatic >= 0.5f) == chromatic && apart <= reach)
      members.push_back(static_cast<int>(i));
  }
  if (members.empty()) // all on the ramp's lesser side
    for (std::size_t i = 0; i < shades.size(); ++i)
      members.push_back(static_cast<int>(i));
  return members;
}

float
median(std::vector<float> values)
{
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Shade and blur between two inks only take away: the purer half shows the surface.
std::vector<int>
purerHalf(const std::vector<Shade>& shades,
          const std::vector<int>& members,
          float Shade::*purity)
{
  std::vector<float> values;
  for (const int i : members)
    values.push_back(shades[i].*purity);
  const float least = median(values);
  std::vector<int> half;
  for (const int i : members)
    if (shades[i].*purity >= least)
      half.push_back(i);
  return half;
}

// Of one colour or of many: 1 x n, BGR 8 bit to L*a*b* float.
cv::Mat3f
toLab(const cv::Mat3b& bgr)
{
  cv::Mat3f unit, lab;
  bgr.convertTo(unit, CV_32F, 1.0 / 255);
  cv::cvtColor(unit, lab, cv::COLOR_BGR2Lab);
  return lab;
}

} // namespace

std::array<double, 3>
labFromRgb(const std::array<unsigned char, 3>& rgb)
{
  const cv::Mat3b pixel(1, 1, cv::Vec3b(rgb[2], rgb[1], rgb[0]));
  const cv::Vec3f lab = toLab(pixel)(0, 0);
  return {lab[0], lab[1], lab[2]};
}

bool
dominantColor(const std::vector<cv::Vec3b>& pixels, Color& color)
{
  color = {};
  if (pixels.empty())
    return false;
  const cv::Mat3b bgr(
      1, static_cast<int>(pixels.size()), const_cast<cv::Vec3b*>(pixels.data()));
  const cv::Mat3f lab = toLab(bgr);
  std::vector<Shade> shades(pixels.size());
  std::transform(lab.begin(), lab.end(), shades.begin(), shadeOf);
  float Shade::*purity = nullptr;
  const std::vector<int> members = largestCluster(shades, purity);

  std::array<std::vector<float>, 3> pure;
  for (const int i : purerHalf(shades, members, purity))
    for (int c = 0; c < 3; ++c)
      pure[c].push_back(lab(0, i)[c]);
  cv::Mat3f middle(1, 1);
  for (int c = 0; c < 3; ++c)
    middle(0, 0)[c] = median(pure[c]);

  cv::Mat3f back;
  cv::cvtColor(middle, back, cv::COLOR_Lab2BGR);
  for (int c = 0; c < 3; ++c)
    color.rgb[c] = cv::saturate_cast<unsigned char>(back(0, 0)[2 - c] * 255.0f);
  color.lab = labFromRgb(color.rgb);
  return true;
}

double
lightnessOfWhite(const std::vector<cv::Vec3b>& pixels)
{
  if (pixels.empty())
    return 100.0;
  const cv::Mat3b bgr(
      1, static_cast<int>(pixels.size()), const_cast<cv::Vec3b*>(pixels.data()));
  std::vector<float> lightness;
  for (const cv::Vec3f& lab : cv::Mat3f(toLab(bgr)))
    lightness.push_back(lab[0]);
  const auto at =
      lightness.begin() + static_cast<std::ptrdiff_t>(lightness.size() * 97 / 100);
  std::nth_element(lightness.begin(), at, lightness.end());
  return std::clamp(static_cast<double>(*at), 80.0, 100.0);
}

} // namespace hoist
