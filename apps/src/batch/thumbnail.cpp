#include "batch/thumbnail.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace hoist {
namespace {

// The overlay's first colours, BGR.
const std::array<cv::Scalar, 5> colors = {cv::Scalar(0, 159, 230),
                                          cv::Scalar(233, 180, 86),
                                          cv::Scalar(125, 190, 20),
                                          cv::Scalar(66, 228, 240),
                                          cv::Scalar(190, 130, 225)};

// Colour, or depth as grey where there is none.
cv::Mat3b
picture(const FrameImages& images)
{
  if (images.hasColor())
    return images.bgr;
  cv::Mat1b grey;
  cv::normalize(images.inverse_depth, grey, 0, 255, cv::NORM_MINMAX, CV_8U);
  cv::Mat3b out;
  cv::cvtColor(grey, out, cv::COLOR_GRAY2BGR);
  return out;
}

void
drawWireframe(cv::Mat3b& image,
              const Cuboid& cuboid,
              const Intrinsics& camera,
              double scale,
              const cv::Scalar& color)
{
  constexpr int shift = 4; // sub-pixels of OpenCV's lines
  const auto corners = cuboid.corners();
  const auto pixel = [&](int i) {
    const Eigen::Vector2d p =
        ((camera.project(corners.col(i)).array() + 0.5) * scale - 0.5) * (1 << shift);
    // a corner beside the camera's plane lies anywhere
    return cv::Point(static_cast<int>(std::clamp(p.x(), -1e5, 1e5)),
                     static_cast<int>(std::clamp(p.y(), -1e5, 1e5)));
  };
  for (const auto& [a, b] : Cuboid::edges())
    if (corners(2, a) > 0 && corners(2, b) > 0)
      cv::line(image, pixel(a), pixel(b), color, 1, cv::LINE_AA, shift);
}

} // namespace

std::string
makeThumbnail(const Frame& frame, const FrameResult& result, int width)
{
  const FrameImages& images = *frame.images;
  const double scale =
      std::min(1.0, width / static_cast<double>(std::max(images.width(), 1)));
  cv::Mat3b small;
  cv::resize(picture(images), small, cv::Size(), scale, scale, cv::INTER_AREA);
  if (images.intrinsics.valid())
    for (std::size_t i = 0; i < result.cuboids.size(); ++i)
      drawWireframe(small,
                    result.cuboids[i].cuboid,
                    images.intrinsics,
                    scale,
                    colors[i % colors.size()]);
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", small, bytes, {cv::IMWRITE_JPEG_QUALITY, 70});
  return {bytes.begin(), bytes.end()};
}

} // namespace hoist
