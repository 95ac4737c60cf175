#include "background.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <vector>

namespace hoist {
namespace {

// Depth as grey, near is bright; linear in 1/z between its 2 % and 98 % quantiles.
cv::Mat3b
depthPicture(const cv::Mat1f& inverse_depth)
{
  std::vector<float> values;
  for (const float w : inverse_depth)
    if (w > 0)
      values.push_back(w);
  cv::Mat3b picture(inverse_depth.size(), cv::Vec3b(0, 0, 0));
  if (values.empty())
    return picture;
  std::sort(values.begin(), values.end());
  const float low = values[values.size() / 50];
  const float high = std::max(values[values.size() * 49 / 50], low * 1.0001f);
  for (int v = 0; v < picture.rows; ++v)
    for (int u = 0; u < picture.cols; ++u)
      if (inverse_depth(v, u) > 0) {
        const auto grey = cv::saturate_cast<unsigned char>(
            60 + 195 * (inverse_depth(v, u) - low) / (high - low));
        picture(v, u) = {grey, grey, grey};
      }
  return picture;
}

// This share of the pixels is at most this bright; at least 1.
double
level(const cv::Mat1b& luma, double share)
{
  std::array<int, 256> histogram{};
  for (const unsigned char value : luma)
    ++histogram[value];
  double rest = (1.0 - share) * static_cast<double>(luma.total());
  int value = 255;
  while (value > 1 && (rest -= histogram[value]) > 0)
    --value;
  return value;
}

} // namespace

cv::Mat3b
background(const FrameImages& images, int scale)
{
  const cv::Mat3b picture =
      images.bgr.empty() ? depthPicture(images.inverse_depth) : images.bgr;
  cv::Mat3b large, grey;
  cv::resize(picture, large, {}, scale, scale, cv::INTER_CUBIC);
  // Some of the colour goes and the light is brought to one level, darker than the
  // lines, whatever the exposure was; a lamp in a dark room must not make it black.
  cv::Mat1b luma;
  cv::cvtColor(large, luma, cv::COLOR_BGR2GRAY);
  const double wanted = std::min(70.0 / level(luma, 0.5), 200.0 / level(luma, 0.9));
  const double gain = std::clamp(std::max(165.0 / level(luma, 0.98), wanted), 0.6, 2.2);
  cv::cvtColor(luma, grey, cv::COLOR_GRAY2BGR);
  cv::Mat3b dimmed;
  cv::addWeighted(large, 0.70 * gain, grey, 0.20 * gain, 0.0, dimmed);
  return dimmed;
}

} // namespace hoist
