#include "planar_faces_pixels.h"

#include <cmath>

namespace hoist {
namespace detail {
namespace {

constexpr int block = 32;

// Whether one of a block of labels is 0.
bool
anyOpen(const short* labels)
{
  int open = 0;
  for (int i = 0; i < block; ++i)
    open |= labels[i] == 0 ? 1 : 0;
  return open != 0;
}

} // namespace

// Closes the pixels that hang together with an open one and leaves them in the queue.
void
PixelLabels::collectPiece(const cv::Mat1f& image, const Pixel& start)
{
  constexpr float max_step = 0.02f; // of the inverse depth
  queue_.clear();
  queue_.push_back(start);
  row(start.v)[start.u] = closed;
  const int down = stride();
  const auto below = static_cast<std::ptrdiff_t>(image.step1());
  for (std::size_t i = 0; i < queue_.size(); ++i) {
    const Pixel p = queue_[i];
    short* label = row(p.v) + p.u;
    const float* w = image[p.v] + p.u;
    const float limit = max_step * *w;
    const auto visit = [&](short& other, float w2, const Pixel& q) {
      if (std::abs(w2 - *w) > limit)
        return;
      other = closed;
      queue_.push_back(q);
    };
    if (label[-1] == 0)
      visit(label[-1], w[-1], {p.u - 1, p.v});
    if (label[1] == 0)
      visit(label[1], w[1], {p.u + 1, p.v});
    if (label[-down] == 0)
      visit(label[-down], w[-below], {p.u, p.v - 1});
    if (label[down] == 0)
      visit(label[down], w[below], {p.u, p.v + 1});
  }
}

PlaneMoments
PixelLabels::sumOfPiece(const cv::Mat1f& image) const
{
  PlaneMoments sum;
  for (const Pixel& p : queue_) {
    const double w = image(p.v, p.u);
    sum.addRun(p.u, p.v, 1, w, 0, w * w);
  }
  return sum;
}

void
PixelLabels::addSlivers(const cv::Mat1f& image,
                        const InverseDepthNoise& noise,
                        int min_pixels,
                        CellRegions& regions)
{
  for (int v = 0; v < height_; ++v) {
    const short* labels = row(v);
    for (int u = 0; u < width_; ++u) {
      if (u % block == 0 && u + block <= width_ && !anyOpen(labels + u)) {
        u += block - 1;
        continue;
      }
      if (labels[u] != 0)
        continue;
      collectPiece(image, {u, v});
      if (queue_.size() < static_cast<std::size_t>(std::max(min_pixels, 3)))
        continue;
      const PlaneMoments sum = sumOfPiece(image);
      Eigen::Vector3d plane;
      if (!sum.fit(plane))
        continue;
      double mean = 0, square = 0;
      sum.residual(plane, mean, square);
      // depth taken half a pixel beside shifts by half a pixel's slope
      const double slope = 0.5 * std::hypot(plane[0], plane[1]);
      constexpr double max_rms = 1.2; // [sigma]
      const double limit = std::hypot(max_rms * noise(sum.w / sum.n), slope);
      if (square > limit * limit || regions.planes.size() >= CellRegions::max_regions)
        continue;
      regions.planes.push_back(plane);
      regions.sums.push_back(sum);
      for (const Pixel& p : queue_)
        row(p.v)[p.u] = static_cast<short>(regions.planes.size());
    }
  }
}

} // namespace detail
} // namespace hoist
