#include <hoist/filters/crease_finder.h>
#include <hoist/filters/depth_edges.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hoist {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr double cells_per_radian = 262; // 320 x 240 at the Kinect's field of view
constexpr float max_fixed = 1 << 22;     // so that a window's sum fits in 31 bits
constexpr int bins = 256;                // of the inverse depth, see chooseWindows
constexpr float weak = 0.6F;    // a crease goes on down to this share of the thresholds
constexpr int peak_reach = 3;   // [cells]; two creases of one sign are farther apart
constexpr int least_cells = 10; // of a crease line
constexpr int band_reach = 2;   // [cells]; rows on either side that are averaged
constexpr int band_rows = 2 * band_reach + 1;

// Unlike cv::Mat::setTo it allocates nothing.
template <typename T>
void
fillZero(cv::Mat_<T>& image)
{
  for (int v = 0; v < image.rows; ++v)
    std::fill(image[v], image[v] + image.cols, T(0));
}

} // namespace

void
CreaseFinder::find(const cv::Mat1f& w,
                   const InverseDepthNoise& noise,
                   const cv::Mat1b& steps,
                   const CreaseParameters& parameters,
                   unsigned char flag,
                   cv::Mat1b& labels)
{
  factor_ = std::max(1, cvRound(parameters.focal / cells_per_radian));
  reduce(w, steps);
  if (std::min(cells_.rows, cells_.cols) < band_rows)
    return;
  chooseWindows(noise, parameters);
  findKinks(cells_, noise, parameters, kinks_);
  cv::transpose(cells_, cells_turned_);
  findKinks(cells_turned_, noise, parameters, kinks_turned_);
  cv::transpose(kinks_turned_, kinks_vertical_);
  findPeaks();
  drawPeaks(w, flag, labels);
}

void
CreaseFinder::reduce(const cv::Mat1f& w, const cv::Mat1b& steps)
{
  const int cols = w.cols / factor_, rows = w.rows / factor_;
  const int half = (factor_ * factor_ + 1) / 2; // rounded up
  const float least = static_cast<float>(half);
  cells_.create(rows, cols);
  sum_.resize(static_cast<std::size_t>(w.cols));
  count_.resize(static_cast<std::size_t>(w.cols));
  float* sum = sum_.data();
  float* count = count_.data();
  for (int v = 0; v < rows; ++v) {
    std::fill(sum, sum + w.cols, 0.0F);
    std::fill(count, count + w.cols, 0.0F);
    for (int k = 0; k < factor_; ++k) {
      const float* in = w[v * factor_ + k];
      const unsigned char* step = steps[v * factor_ + k];
      for (int u = 0; u < w.cols; ++u) {
        sum[u] += in[u];
        // a step anywhere in the cell spoils it
        count[u] += (in[u] > 0 ? 1.0F : 0.0F) - 1000.0F * static_cast<float>(step[u]);
      }
    }
    float* out = cells_[v];
    if (factor_ == 2)
      for (int u = 0; u < cols; ++u) {
        const float total = count[2 * u] + count[2 * u + 1];
        out[u] = total >= least ? (sum[2 * u] + sum[2 * u + 1]) / total : nan;
      }
    else
      for (int u = 0; u < cols; ++u) {
        float total_sum = 0, total = 0;
        for (int k = u * factor_; k < (u + 1) * factor_; ++k) {
          total_sum += sum[k];
          total += count[k];
        }
        out[u] = total >= least ? total_sum / total : nan;
      }
  }
}

void
CreaseFinder::chooseWindows(const InverseDepthNoise& noise,
                            const CreaseParameters& parameters)
{
  float most = 0;
  for (int v = 0; v < cells_.rows; ++v) {
    const float* row = cells_[v];
    for (int u = 0; u < cells_.cols; ++u)
      most = row[u] > most ? row[u] : most; // never NaN
  }
  w_to_bin_ = most > 0 ? (bins - 1) / most : 0;
  to_fixed_ = most > 0 ? max_fixed / most : 0;
  const float from_fixed = most / max_fixed;
  for (int d = min_reach; d <= max_reach; ++d) {
    Window& window = windows_[d];
    window.block = (d + 1) / 2;
    window.middle = d / 4;
    const int m = window.middle;
    // means of |x| over the outer and the central blocks
    const float outer = static_cast<float>(d) - (window.block - 1) / 2.0F;
    const float inner = m * (m + 1) / static_cast<float>(2 * m + 1);
    window.gain = 2 / (outer - inner);
    // Noise is taken as common to a cell and independent between cells.
    window.sigma = window.gain * std::sqrt(1.0F / (2 * band_rows * window.block) +
                                           1.0F / (band_rows * (2 * m + 1)));
    window.per_outer = from_fixed / static_cast<float>(window.block);
    window.per_middle = from_fixed / static_cast<float>(2 * m + 1);
    window.per_base = 1.0F / static_cast<float>(2 * d - window.block + 1);
    window.per_sigma = 1.0F / (static_cast<float>(parameters.sigmas) * window.sigma);
  }
  reach_of_w_.resize(bins);
  const double focal = parameters.focal / factor_;
  for (int i = 0; i < bins; ++i) {
    const float w = std::max(1, i) / static_cast<float>(bins - 1) * most;
    const double wanted = std::tan(parameters.angle) * w / focal;
    int d = min_reach + 1;
    while (d < max_reach && parameters.sigmas * noise(w) * windows_[d].sigma > wanted)
      ++d;
    reach_of_w_[i] = static_cast<unsigned char>(d);
  }
}

void
CreaseFinder::findKinks(const cv::Mat1f& cells,
                        const InverseDepthNoise& noise,
                        const CreaseParameters& parameters,
                        cv::Mat1f& kinks)
{
  const int rows = cells.rows, cols = cells.cols;
  const float to_focal = static_cast<float>(parameters.focal / factor_);
  const float tan_angle = static_cast<float>(std::tan(parameters.angle));
  kinks.create(cells.size());
  fillZero(kinks);
  band_.resize(static_cast<std::size_t>(cols));
  prefix_.resize(static_cast<std::size_t>(cols) + 1);
  reach_.resize(static_cast<std::size_t>(cols) + 1);
  float* band = band_.data();
  int* reach = reach_.data();

  for (int v = band_reach; v < rows - band_reach; ++v) {
    float* out = kinks[v];
    const float* first = cells[v - band_reach];
    std::copy(first, first + cols, band);
    for (int k = 1 - band_reach; k <= band_reach; ++k) {
      const float* row = cells[v + k];
      for (int u = 0; u < cols; ++u)
        band[u] += row[u]; // NaN spoils the band, as it should
    }
    for (int u = 0; u < cols; ++u)
      band[u] = band[u] > 0 ? band[u] * (1.0F / band_rows) : 0.0F;
    // Sums in fixed point: exact, and where they wrap around differences do not.
    std::uint32_t sum = prefix_[0] = 0;
    for (int u = 0; u < cols; ++u)
      prefix_[u + 1] = sum +=
          static_cast<std::uint32_t>(static_cast<int>(band[u] * to_fixed_));
    chooseReach(cols);
    for (int u = 0; u < cols;) {
      // cells of one window size together, so that the compiler can vectorize
      int end = u + 1;
      while (end < cols && reach[end] == reach[u])
        ++end;
      if (reach[u] >= min_reach)
        kinksOfWindow(u, end, reach[u], noise, out);
      u = end;
    }
    // where noise does not decide, the angle does
    for (int u = 0; u < cols; ++u) {
      const float by_noise = std::abs(out[u]);
      if (by_noise < weak / 2)
        continue; // far from a crease whatever its angle
      const Window& window = windows_[reach[u]];
      const Blocks blocks = blocksAt(u, reach[u]);
      const float kink = blocks.kink * window.gain;
      const float slope = blocks.rise * window.per_base;
      const float to_tangent = to_focal / band[u];
      const float t1 = (slope - kink / 2) * to_tangent;
      const float t2 = (slope + kink / 2) * to_tangent;
      const float needed = tan_angle * std::max(0.0F, 1 + t1 * t2);
      const float change = std::abs(kink) * to_tangent;
      if (change < needed * by_noise)
        out[u] = std::copysign(change / needed, kink);
    }
  }
}

void
CreaseFinder::chooseReach(int cols)
{
  const float* band = band_.data();
  int* reach = reach_.data();
  int free = -1;
  for (int u = cols - 1; u >= 0; --u) {
    free = band[u] > 0 ? free + 1 : -1;
    reach[u] = free;
  }
  free = -1;
  for (int u = 0; u < cols; ++u) {
    free = band[u] > 0 ? free + 1 : -1;
    const int wanted = reach_of_w_[static_cast<int>(band[u] * w_to_bin_)];
    reach[u] = std::min(wanted, std::min(free, reach[u]));
  }
}

CreaseFinder::Blocks
CreaseFinder::blocksAt(int u, int d) const
{
  const Window& window = windows_[d];
  const std::uint32_t* at = prefix_.data() + u;
  const int b = window.block, m = window.middle;
  const float left =
      static_cast<float>(static_cast<int>(at[b - d] - at[-d])) * window.per_outer;
  const float right = static_cast<float>(static_cast<int>(at[d + 1] - at[d + 1 - b])) *
                      window.per_outer;
  const float centre =
      static_cast<float>(static_cast<int>(at[m + 1] - at[-m])) * window.per_middle;
  return {(left + right) * 0.5F - centre, right - left};
}

void
CreaseFinder::kinksOfWindow(int begin,
                            int end,
                            int d,
                            const InverseDepthNoise& noise,
                            float* out) const
{
  // Local copies: stores through `out` could change the members as far as the compiler
  // knows, and it would not vectorize.
  const Window window = windows_[d];
  const float outer = 0.5F * window.per_outer * window.gain * window.per_sigma;
  const float middle = window.per_middle * window.gain * window.per_sigma;
  const float a = noise.a, b = noise.b, c = noise.c;
  const float* band = band_.data() + begin;
  const std::uint32_t* at = prefix_.data() + begin;
  const std::uint32_t* left = at - d;
  const std::uint32_t* left_end = left + window.block;
  const std::uint32_t* right_end = at + d + 1;
  const std::uint32_t* right = right_end - window.block;
  const std::uint32_t* centre = at - window.middle;
  const std::uint32_t* centre_end = at + window.middle + 1;
  out += begin;
  for (int u = 0; u < end - begin; ++u) {
    const float at_ends = static_cast<float>(
        static_cast<int>(left_end[u] - left[u] + right_end[u] - right[u]));
    const float at_centre =
        static_cast<float>(static_cast<int>(centre_end[u] - centre[u]));
    out[u] = (at_ends * outer - at_centre * middle) / (a + band[u] * (b + band[u] * c));
  }
}

void
CreaseFinder::findPeaks()
{
  const int rows = cells_.rows, cols = cells_.cols;
  peaks_.create(cells_.size());
  position_.create(cells_.size());
  fillZero(peaks_);

  // Is the value at p the largest of its sign among its neighbours along the line?
  const auto isPeak = [](const float* p, std::ptrdiff_t stride, int before, int after) {
    const float sign = *p < 0 ? -1.0F : 1.0F;
    const float value = *p * sign;
    for (int i = 1; i <= std::min(peak_reach, before); ++i)
      if (p[-i * stride] * sign >= value)
        return false;
    for (int i = 1; i <= std::min(peak_reach, after); ++i)
      if (p[i * stride] * sign > value)
        return false;
    return true;
  };
  // Offset of the top of the parabola through a peak and its two neighbours.
  const auto top = [](const float* p, std::ptrdiff_t stride) {
    const float sign = *p < 0 ? -1.0F : 1.0F;
    const float a = p[-stride] * sign, b = *p * sign, c = p[stride] * sign;
    const float bend = a - 2 * b + c;
    return bend < 0 ? std::clamp(0.5F * (a - c) / bend, -0.5F, 0.5F) : 0.0F;
  };
  const auto stride = static_cast<std::ptrdiff_t>(kinks_vertical_.step1());
  const float middle = (factor_ - 1) / 2.0F;
  for (int v = 1; v + 1 < rows; ++v) {
    const float* across = kinks_[v];
    const float* down = kinks_vertical_[v];
    for (int u = 1; u + 1 < cols; ++u) {
      const float h = std::abs(across[u]), k = std::abs(down[u]);
      if (std::max(h, k) < weak)
        continue;
      cv::Point2f offset(0, 0);
      if (h >= k) {
        if (!isPeak(across + u, 1, u, cols - 1 - u))
          continue;
        offset.x = top(across + u, 1);
      }
      else {
        if (!isPeak(down + u, stride, v, rows - 1 - v))
          continue;
        offset.y = top(down + u, stride);
      }
      peaks_(v, u) = std::max(h, k) >= 1 ? 2 : 1;
      position_(v, u) = {(u + offset.x) * factor_ + middle,
                         (v + offset.y) * factor_ + middle};
    }
  }
}

void
CreaseFinder::drawPeaks(const cv::Mat1f& w, unsigned char flag, cv::Mat1b& labels)
{
  constexpr unsigned char seen = 3;
  const int rows = peaks_.rows, cols = peaks_.cols;
  // lines shift by up to two cells from one row to the next
  const auto forNeighbours = [&](int cell, const auto& f) {
    const int v = cell / cols, u = cell % cols;
    for (int dv = -2; dv <= 2; ++dv)
      for (int du = -2; du <= 2; ++du) {
        if (std::abs(du) + std::abs(dv) > 3 || (du == 0 && dv == 0))
          continue;
        const int nv = v + dv, nu = u + du;
        if (nv >= 0 && nu >= 0 && nv < rows && nu < cols && peaks_(nv, nu) != 0)
          f(nv * cols + nu);
      }
  };
  unsigned char* peak = peaks_[0];
  for (int seed = 0; seed < rows * cols; ++seed) {
    if (peak[seed] != 2)
      continue;
    stack_.clear();
    stack_.push_back(seed);
    peak[seed] = seen;
    for (std::size_t next = 0; next < stack_.size(); ++next)
      forNeighbours(stack_[next], [&](int i) {
        if (peak[i] == seen)
          return;
        peak[i] = seen;
        stack_.push_back(i);
      });
    if (stack_.size() < least_cells)
      continue;
    const cv::Vec2f* position = position_[0];
    for (const int cell : stack_)
      forNeighbours(cell, [&](int i) {
        if (i > cell)
          drawLine(
              cv::Point2f(position[cell]), cv::Point2f(position[i]), w, flag, labels);
      });
  }
}

void
CreaseFinder::drawLine(cv::Point2f from,
                       cv::Point2f to,
                       const cv::Mat1f& w,
                       unsigned char flag,
                       cv::Mat1b& labels) const
{
  const cv::Point2f d = to - from;
  const int steps = std::max(1, cvCeil(std::max(std::abs(d.x), std::abs(d.y))));
  for (int i = 0; i <= steps; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(steps);
    // not cvRound: it rounds halves to even, which would leave out every second row
    const int u = cvFloor(from.x + t * d.x + 0.5F);
    const int v = cvFloor(from.y + t * d.y + 0.5F);
    if (u >= 0 && v >= 0 && u < w.cols && v < w.rows && w(v, u) > 0)
      labels(v, u) |= flag;
  }
}

} // namespace hoist
