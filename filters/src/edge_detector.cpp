#include <hoist/filters/edge_detector.h>

#include <algorithm>
#include <array>
#include <stdexcept>

namespace hoist {
namespace {

constexpr int max_radius = 16;

// Offsets within max_radius, nearest first; ties in raster order.
struct Offsets {
  struct Offset {
    int u, v, square;
  };
  std::array<Offset, (2 * max_radius + 1) * (2 * max_radius + 1)> all{};

  Offsets()
  {
    std::size_t n = 0;
    for (int v = -max_radius; v <= max_radius; ++v)
      for (int u = -max_radius; u <= max_radius; ++u)
        all[n++] = {u, v, u * u + v * v};
    std::stable_sort(all.begin(), all.end(), [](const Offset& a, const Offset& b) {
      return a.square < b.square;
    });
  }
};

} // namespace

void
addContours(const cv::Mat1b& contours,
            const cv::Mat1f& inverse_depth,
            const cv::Mat1b& steps,
            const EdgeParameters& parameters,
            cv::Mat1b& labels)
{
  static const Offsets offsets;
  const int radius = parameters.near_side_radius;
  if (radius < 0 || radius > max_radius)
    throw std::invalid_argument("hoist::EdgeDetector: near_side_radius must be in "
                                "0 ... 16");
  const InverseDepthNoise noise(parameters.depth.sensor);
  const float sigmas = static_cast<float>(parameters.depth.step_sigmas) * 1.41421F;
  const cv::Rect frame({0, 0}, contours.size());

  for (int v = 0; v < contours.rows; ++v) {
    const unsigned char* contour = contours[v];
    for (int u = 0; u < contours.cols; ++u) {
      if (contour[u] == 0)
        continue;
      const float w = inverse_depth(v, u);
      cv::Point to(u, v), measured(-1, -1);
      int measured_square = 0;
      bool moved = false;
      if (steps(v, u) != DepthEdges::step_near)
        for (const auto& offset : offsets.all) {
          if (offset.square > radius * radius)
            break;
          const cv::Point p(u + offset.u, v + offset.v);
          if (!frame.contains(p))
            continue;
          const float near_w = inverse_depth(p);
          if (near_w <= 0)
            continue;
          if (steps(p) == DepthEdges::step_near &&
              (w <= 0 || near_w - w > sigmas * noise(near_w))) {
            to = p;
            moved = true;
            break;
          }
          if (measured.x < 0 ||
              (offset.square == measured_square && near_w > inverse_depth(measured))) {
            measured = p;
            measured_square = offset.square;
          }
        }
      if (!moved && w <= 0) {
        if (measured.x < 0)
          continue;
        to = measured;
      }
      labels(to) |= EDGE_COLOR;
    }
  }
}

void
EdgeDetector::detect(const FrameImages& images,
                     const EdgeParameters& parameters,
                     cv::Mat1b& labels)
{
  inverse_depth_ = images.inverse_depth;
  depth_labels_.create(inverse_depth_.size());
  depth_labels_.setTo(0);
  // the steps are needed for the contours too
  depth_edges_.detect(inverse_depth_,
                      images.intrinsics,
                      parameters.depth,
                      parameters.kinds,
                      depth_labels_);
  has_color_ = (parameters.kinds & EDGE_COLOR) != 0 && images.hasColor();
  if (has_color_)
    canny_.setImage(images.gray, parameters.canny.blur_sigma);
  redetect(parameters, labels);
}

void
EdgeDetector::redetect(const EdgeParameters& parameters, cv::Mat1b& labels)
{
  depth_labels_.copyTo(labels);
  if (!has_color_) {
    contours_.release();
    return;
  }
  canny_.detect(parameters.canny, contours_);
  addContours(contours_, inverse_depth_, depth_edges_.getSteps(), parameters, labels);
}

} // namespace hoist
