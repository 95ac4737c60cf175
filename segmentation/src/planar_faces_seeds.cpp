#include "planar_faces_seeds.h"

#include <algorithm>
#include <cmath>

namespace hoist {
namespace detail {
namespace {

constexpr int size = CellGrid::size;
constexpr int large = 4;                    // cells of a large window
constexpr float max_flatness = 1.6f * 1.6f; // [sigma^2]

int
binOf(float flatness)
{
  constexpr float scale = FlatWindows::bins / max_flatness;
  return std::min(FlatWindows::bins - 1, static_cast<int>(flatness * scale));
}

// Mean square residual of the window's own plane over sigma squared.
bool
flatnessOf(const PlaneMoments& sum, const InverseDepthNoise& noise, double& flatness)
{
  Eigen::Vector3d plane;
  if (!sum.fit(plane))
    return false;
  double mean = 0, square = 0;
  sum.residual(plane, mean, square);
  const double sigma = noise(sum.w / sum.n);
  flatness = square / (sigma * sigma);
  return true;
}

} // namespace

double
FlatWindows::measure(const CellGrid& grid, const InverseDepthNoise& noise)
{
  const int columns = grid.columns - large + 1, rows = grid.rows - large + 1;
  large_.resize(columns > 0 && rows > 0 ? static_cast<std::size_t>(columns) * rows : 0);
  if (!large_.empty()) {
    for (int r = 0; r + 1 < large; ++r)
      sumRow(grid, r);
    for (int r = 0; r < rows; ++r) {
      sumRow(grid, r + large - 1);
      fullWindows(grid, noise, r);
    }
  }
  scale_ = noiseScale(grid, noise);
  return scale_;
}

double
FlatWindows::noiseScale(const CellGrid& grid, const InverseDepthNoise& noise)
{
  constexpr double floor = 0.05, ceiling = 1.0, waves = 2.0;
  const int columns = grid.columns - large + 1;
  flattest_.clear();
  for (int r = 0; r + large <= grid.rows; r += large)
    for (int c = 0; c < columns; c += large) {
      double flatness = large_[static_cast<std::size_t>(r) * columns + c];
      if (flatness < 0) {
        const PlaneMoments sum = grid.moments({c, r, large, large});
        if (sum.n < large * large * CellGrid::min_pixels ||
            !flatnessOf(sum, noise, flatness))
          continue;
      }
      flattest_.push_back(static_cast<float>(flatness));
    }
  if (flattest_.empty())
    return ceiling;
  const auto quartile =
      flattest_.begin() + static_cast<std::ptrdiff_t>(flattest_.size() / 4);
  std::nth_element(flattest_.begin(), quartile, flattest_.end());
  return std::min(ceiling, std::max(floor, waves * std::sqrt(*quartile)));
}

void
FlatWindows::sumRow(const CellGrid& grid, int row)
{
  RowSums& out = ring_[row % large];
  const int count = grid.columns - large + 1;
  out.w.resize(count);
  out.uw.resize(count);
  out.vw.resize(count);
  out.ww.resize(count);
  out.measured.resize(count);
  const CellGrid::Cell* cells = &grid.cells[grid.index(0, row)];
  const std::uint16_t* m = &grid.measured[grid.index(0, row)];
  double *w = out.w.data(), *uw = out.uw.data(), *vw = out.vw.data(),
         *ww = out.ww.data();
  std::uint16_t* om = out.measured.data();
  // of full cells: their middles lie 1.5 and 0.5 cells beside the window's
  constexpr double outer = 1.5 * size, inner = 0.5 * size;
  for (int c = 0; c < count; ++c) {
    const double a = cells[c].w, b = cells[c + 1].w, d = cells[c + 2].w,
                 e = cells[c + 3].w;
    w[c] = (a + b) + (d + e);
    ww[c] = (a * a + b * b) + (d * d + e * e);
    uw[c] = outer * (e - a) + inner * (d - b);
  }
  for (int c = 0; c < count; ++c) {
    const CellGrid::Cell *a = cells + c, *b = a + 1, *d = a + 2, *e = a + 3;
    uw[c] += (a->uw + b->uw) + (d->uw + e->uw);
    vw[c] = (a->vw + b->vw) + (d->vw + e->vw);
    ww[c] += (a->ww + b->ww) + (d->ww + e->ww);
  }
  for (int c = 0; c < count; ++c)
    om[c] = m[c] & m[c + 1] & m[c + 2] & m[c + 3];
}

void
FlatWindows::fullWindows(const CellGrid& grid, const InverseDepthNoise& noise, int row)
{
  // means over the window's cells; of n x n pixels the spread is a constant
  constexpr double cells = large * large, part = 1 / cells;
  constexpr double n = size * large, spread = (n * n - 1) / 12;
  constexpr double outer = 1.5 * size, inner = 0.5 * size;
  const int count = grid.columns - large + 1;
  const RowSums &r0 = ring_[row % large], &r1 = ring_[(row + 1) % large],
                &r2 = ring_[(row + 2) % large], &r3 = ring_[(row + 3) % large];
  float* out = &large_[static_cast<std::size_t>(row) * count];
  const double *w0 = r0.w.data(), *w1 = r1.w.data(), *w2 = r2.w.data(),
               *w3 = r3.w.data();
  const double *u0 = r0.uw.data(), *u1 = r1.uw.data(), *u2 = r2.uw.data(),
               *u3 = r3.uw.data();
  const double *v0 = r0.vw.data(), *v1 = r1.vw.data(), *v2 = r2.vw.data(),
               *v3 = r3.vw.data();
  const double *q0 = r0.ww.data(), *q1 = r1.ww.data(), *q2 = r2.ww.data(),
               *q3 = r3.ww.data();
  for (int c = 0; c < count; ++c) {
    const double w = part * ((w0[c] + w1[c]) + (w2[c] + w3[c]));
    const double uw = part * ((u0[c] + u1[c]) + (u2[c] + u3[c]));
    const double vw = part * ((v0[c] + v1[c]) + (v2[c] + v3[c]) +
                              outer * (w3[c] - w0[c]) + inner * (w2[c] - w1[c]));
    const double ww = part * ((q0[c] + q1[c]) + (q2[c] + q3[c])) - w * w;
    const double square = ww - (uw * uw + vw * vw) * (1 / spread);
    const double sigma = noise.constant + w * (noise.linear + w * noise.square);
    out[c] = static_cast<float>(std::max(0.0, square) / (sigma * sigma));
  }
  const std::uint16_t *m0 = r0.measured.data(), *m1 = r1.measured.data(),
                      *m2 = r2.measured.data(), *m3 = r3.measured.data();
  for (int c = 0; c < count; ++c)
    out[c] = (m0[c] & m1[c] & m2[c] & m3[c]) == CellGrid::full ? out[c] : -1.0F;
}

void
FlatWindows::collect(const CellGrid& grid,
                     const InverseDepthNoise& noise,
                     const std::vector<short>& owner,
                     int width,
                     int height)
{
  found_.clear();
  const bool known = width == large && height == large;
  const int columns = grid.columns - width + 1, rows = grid.rows - height + 1;
  const double unit = 1 / (scale_ * scale_);
  for (int r = 0; r < rows; ++r) {
    const short* own = &owner[grid.index(0, r)];
    const float* full =
        known && columns > 0 ? &large_[static_cast<std::size_t>(r) * columns] : nullptr;
    for (int c = 0; c < columns; ++c) {
      if (own[c] != 0)
        continue;
      double flatness = full != nullptr ? full[c] * unit : -1;
      if (flatness < 0) {
        bool free = true;
        for (int y = 0; y < height && free; ++y)
          for (int x = 0; x < width; ++x)
            free = free && own[y * grid.stride + c + x] == 0;
        if (!free || !flatnessOf(grid.moments({c, r, width, height}), noise, flatness))
          continue;
      }
      if (flatness < max_flatness)
        found_.push_back({static_cast<float>(flatness), c, r});
    }
  }
  // Counting sort: most seeds of the later groups will be taken by then, so that there
  // is little left to sort.
  first_.fill(0);
  for (const Seed& s : found_)
    ++first_[binOf(s.flatness) + 1];
  for (int i = 0; i < bins; ++i)
    first_[i + 1] += first_[i];
  sorted_.resize(found_.size());
  std::array<int, bins + 1> next = first_;
  for (const Seed& s : found_)
    sorted_[next[binOf(s.flatness)]++] = s;
}

const std::vector<FlatWindows::Seed>&
FlatWindows::bin(int number, const CellGrid& grid, const std::vector<short>& owner)
{
  free_.clear();
  for (int i = first_[number]; i < first_[number + 1]; ++i)
    if (owner[grid.index(sorted_[i].column, sorted_[i].row)] == 0)
      free_.push_back(sorted_[i]);
  // equals stay in the order of the image, found_ is in it
  std::sort(free_.begin(), free_.end(), [](const Seed& a, const Seed& b) {
    return a.flatness != b.flatness ? a.flatness < b.flatness
           : a.row != b.row         ? a.row < b.row
                                    : a.column < b.column;
  });
  return free_;
}

} // namespace detail
} // namespace hoist
