#include "planar_faces_pixels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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

// Whether measurements lie on one plane, which is fitted.
bool
flat(const PlaneMoments& sum, const InverseDepthNoise& noise, Eigen::Vector3d& plane)
{
  if (!sum.fit(plane))
    return false;
  double mean = 0, square = 0;
  sum.residual(plane, mean, square);
  // depth taken half a pixel beside shifts by half a pixel's slope
  const double slope = 0.5 * std::hypot(plane[0], plane[1]);
  constexpr double max_rms = 1.2; // [sigma]
  const double limit = std::hypot(max_rms * noise(sum.w / sum.n), slope);
  return square <= limit * limit;
}

PlaneMoments
sumOf(const PixelLabels::Range& pixels, const cv::Mat1f& image)
{
  PlaneMoments sum;
  for (const PixelLabels::Pixel& p : pixels) {
    const double w = image(p.v, p.u);
    sum.addRun(p.u, p.v, 1, w, 0, w * w);
  }
  return sum;
}

// Along which line of the image a piece is split, and where.
struct Split {
  double cosine = 0, sine = 0, at = 0;

  bool
  second(const PixelLabels::Pixel& p) const
  {
    return cosine * p.u + sine * p.v > at;
  }
};

// The bend of a narrow strip: the place along its length where two planes fit best.
bool
findSplit(const PixelLabels::Range& pixels,
          const PlaneMoments& sum,
          const cv::Mat1f& image,
          int min_pixels,
          Split& split)
{
  const double mu = sum.u / sum.n, mv = sum.v / sum.n;
  const double angle =
      0.5 * std::atan2(2 * (sum.uv / sum.n - mu * mv),
                       sum.uu / sum.n - mu * mu - (sum.vv / sum.n - mv * mv));
  split.cosine = std::cos(angle);
  split.sine = std::sin(angle);
  const auto along = [&](const PixelLabels::Pixel& p) {
    return split.cosine * p.u + split.sine * p.v;
  };
  const auto by = [&](const PixelLabels::Pixel& a, const PixelLabels::Pixel& b) {
    return along(a) < along(b);
  };
  const auto [lowest, highest] = std::minmax_element(pixels.begin(), pixels.end(), by);
  const double low = along(*lowest), length = along(*highest) - low + 1e-9;
  constexpr int bins = 48;
  std::array<PlaneMoments, bins> part;
  for (const PixelLabels::Pixel& p : pixels) {
    const double w = image(p.v, p.u);
    part[static_cast<int>((along(p) - low) / length * (bins - 1))].addRun(
        p.u, p.v, 1, w, 0, w * w);
  }
  // from the far end, then from the near one
  std::array<PlaneMoments, bins + 1> rest;
  for (int i = bins; i-- > 0;) {
    rest[i] = rest[i + 1];
    rest[i] += part[i];
  }
  const auto cost = [](const PlaneMoments& m) {
    Eigen::Vector3d plane;
    double mean = 0, square = 0;
    if (!m.fit(plane))
      return std::numeric_limits<double>::infinity();
    m.residual(plane, mean, square);
    return square * m.n;
  };
  double best = std::numeric_limits<double>::infinity();
  PlaneMoments first;
  for (int i = 0; i + 1 < bins; ++i) {
    first += part[i];
    if (first.n < min_pixels || rest[i + 1].n < min_pixels)
      continue;
    const double total = cost(first) + cost(rest[i + 1]);
    if (total < best) {
      best = total;
      split.at = low + (i + 1) * length / (bins - 1);
    }
  }
  return best < std::numeric_limits<double>::infinity();
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

// A piece that is flat becomes a region; a strip around the corner of a thin slab is
// two, or three.
void
PixelLabels::addPiece(const cv::Mat1f& image,
                      const InverseDepthNoise& noise,
                      const Range& piece,
                      int min_pixels,
                      int splits,
                      CellRegions& regions)
{
  if (piece.last - piece.first < min_pixels ||
      regions.planes.size() >= CellRegions::max_regions)
    return;
  const PlaneMoments sum = sumOf(piece, image);
  Eigen::Vector3d plane;
  if (flat(sum, noise, plane)) {
    regions.planes.push_back(plane);
    regions.sums.push_back(sum);
    for (const Pixel& p : piece)
      row(p.v)[p.u] = static_cast<short>(regions.planes.size());
    return;
  }
  Split split;
  if (splits == 0 || !findSplit(piece, sum, image, min_pixels, split))
    return;
  Pixel* const middle = std::partition(
      piece.begin(), piece.end(), [&](const Pixel& p) { return !split.second(p); });
  addPiece(image, noise, {piece.first, middle}, min_pixels, splits - 1, regions);
  addPiece(image, noise, {middle, piece.last}, min_pixels, splits - 1, regions);
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
      constexpr int max_splits = 2;
      addPiece(image,
               noise,
               {queue_.data(), queue_.data() + queue_.size()},
               std::max(min_pixels, 3),
               max_splits,
               regions);
    }
  }
}

} // namespace detail
} // namespace hoist
