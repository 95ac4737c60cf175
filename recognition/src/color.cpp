#include <hoist/recognition/color.h>

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace hoist {
namespace {

// How far two shades of one surface lie apart; about the width of a basic colour's
// core.
constexpr float radius = 12.0f;
constexpr float lightness_weight = 0.5f;
constexpr int bins = 24; // of 256 / 24 = 10.7 units: just under the radius

// L* scaled as it counts.
cv::Vec3f
weighted(const cv::Vec3f& lab)
{
  return {lightness_weight * lab[0], lab[1], lab[2]};
}

int
bin(float value)
{
  return std::clamp(static_cast<int>((value + 128.0f) * (bins / 256.0f)), 0, bins - 1);
}

int
histogramCell(const cv::Vec3f& p)
{
  return (bin(p[0]) * bins + bin(p[1])) * bins + bin(p[2]);
}

cv::Vec3f
centreOfFullestCell(const std::vector<cv::Vec3f>& pixels)
{
  std::vector<int> histogram(bins * bins * bins, 0);
  for (const cv::Vec3f& p : pixels)
    ++histogram[histogramCell(p)];
  const auto fullest = static_cast<int>(
      std::max_element(histogram.begin(), histogram.end()) - histogram.begin());
  cv::Vec3d sum(0, 0, 0);
  for (const cv::Vec3f& p : pixels)
    if (histogramCell(p) == fullest)
      sum += cv::Vec3d(p);
  return sum / static_cast<double>(histogram[fullest]);
}

// Mean shift with a flat kernel; ends where the mean stays.
cv::Vec3f
climb(const std::vector<cv::Vec3f>& pixels, cv::Vec3f center)
{
  constexpr int max_iterations = 20;
  constexpr double still = 0.05; // [Lab units], far below one 8 bit step
  for (int i = 0; i < max_iterations; ++i) {
    cv::Vec3d sum(0, 0, 0);
    int n = 0;
    for (const cv::Vec3f& p : pixels)
      if (cv::norm(p - center) <= radius) {
        sum += cv::Vec3d(p);
        ++n;
      }
    if (n == 0)
      return center;
    const cv::Vec3f next = sum / static_cast<double>(n);
    const double shift = cv::norm(next - center);
    center = next;
    if (shift < still)
      break;
  }
  return center;
}

float
median(std::vector<float>& values)
{
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
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
  std::vector<cv::Vec3f> scaled(pixels.size());
  std::transform(lab.begin(), lab.end(), scaled.begin(), weighted);
  const cv::Vec3f mode = climb(scaled, centreOfFullestCell(scaled));

  std::array<std::vector<float>, 3> near;
  for (std::size_t i = 0; i < scaled.size(); ++i)
    if (cv::norm(scaled[i] - mode) <= radius)
      for (int c = 0; c < 3; ++c)
        near[c].push_back(lab(0, static_cast<int>(i))[c]);
  cv::Mat3f middle(1, 1);
  for (int c = 0; c < 3; ++c)
    middle(0, 0)[c] = median(near[c]);

  cv::Mat3f back;
  cv::cvtColor(middle, back, cv::COLOR_Lab2BGR);
  for (int c = 0; c < 3; ++c)
    color.rgb[c] = cv::saturate_cast<unsigned char>(back(0, 0)[2 - c] * 255.0f);
  color.lab = labFromRgb(color.rgb);
  return true;
}

std::string
colorName(const std::array<double, 3>& lab)
{
  const double lightness = lab[0];
  const double chroma = std::hypot(lab[1], lab[2]);
  double hue = std::atan2(lab[2], lab[1]) * 180.0 / CV_PI;
  if (hue < 0)
    hue += 360.0;

  // What is nearly white, nearly black or nearly without hue. Shade takes chroma away
  // together with lightness, so the dark need less of it.
  const double least_chroma = std::min(10.0, 1.0 + 0.25 * lightness);
  if (chroma < least_chroma || (lightness > 90.0 && chroma < 20.0) ||
      (lightness < 10.0 && chroma < 20.0)) {
    if (lightness > 86.0)
      return "white";
    return lightness < 22.0 ? "black" : "grey";
  }
  if (hue < 50.0 || hue >= 345.0) { // reds
    if (lightness > 62.0 || (lightness > 45.0 && hue >= 345.0))
      return "pink";
    return chroma < 45.0 && hue > 15.0 ? "brown" : "red";
  }
  if (hue < 84.0) // oranges; dark or dull orange is brown
    return lightness >= 58.0 && chroma >= 45.0 ? "orange" : "brown";
  if (hue < 112.0) { // yellows; dark yellow is brown, or olive, which counts as green
    if (lightness >= 65.0)
      return chroma >= 25.0 || hue >= 95.0 ? "yellow" : "brown";
    return hue < 98.0 ? "brown" : "green";
  }
  if (hue < 200.0)
    return "green";
  if (hue < 310.0)
    return hue >= 300.0 && lightness > 45.0 && chroma < 80.0 ? "purple" : "blue";
  if (hue < 332.0 || lightness < 45.0)
    return "purple";
  return "pink";
}

} // namespace hoist
