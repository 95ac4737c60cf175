#include "planar_faces_describe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace hoist {
namespace detail {
namespace {

constexpr std::uint64_t ones = 0x0001000100010001; // in four labels at once

std::uint64_t
fourLabels(const short* labels)
{
  std::uint64_t word = 0;
  std::memcpy(&word, labels, sizeof(word));
  return word;
}

std::uint64_t
fourTimes(short label)
{
  return ones * static_cast<std::uint16_t>(label);
}

// False where the pixels make no plane in front of the camera.
bool
toFace(const PlaneMoments& m,
       const InverseDepthNoise& noise,
       const Intrinsics& camera,
       PlanarFace& face)
{
  if (!m.fit(face.inverse_depth))
    return false;
  const Eigen::Vector3d& p = face.inverse_depth;
  // 1/z = a u + b v + c with u = fx x/z + cx, v = fy y/z + cy gives
  // (a fx) x + (b fy) y + (a cx + b cy + c) z = 1
  const Eigen::Vector3d g(
      p[0] * camera.fx, p[1] * camera.fy, p[0] * camera.cx + p[1] * camera.cy + p[2]);
  const double norm = g.norm();
  if (norm < 1e-9)
    return false;
  face.normal = -g / norm; // g . x = 1 > 0 on the plane, so -g looks at the camera
  face.offset = 1 / norm;
  const double mu = m.u / m.n, mv = m.v / m.n;
  const double w = p[0] * mu + p[1] * mv + p[2];
  face.centroid = camera.ray(mu, mv) / w;
  face.pixels = static_cast<int>(m.n);
  double mean = 0, square = 0;
  m.residual(p, mean, square);
  const double s = noise(m.w / m.n);
  face.rms = std::sqrt(square) / s;
  // the smaller eigenvalue of the pixels' spread in the image
  const double uu = m.uu - m.n * mu * mu, uv = m.uv - m.n * mu * mv,
               vv = m.vv - m.n * mv * mv;
  const double weakest = 0.5 * (uu + vv - std::hypot(uu - vv, 2 * uv));
  // neighbouring depths are correlated: the notes' factor 50 on the variance
  constexpr double correlation = 50;
  const double slope = s * std::sqrt(correlation / std::max(weakest, 1e-9));
  face.normal_sigma = slope * std::max(camera.fx, camera.fy) / norm;
  return true;
}

} // namespace

void
FaceDescriber::extend(short label, int left, int top, int right, int bottom)
{
  Bounds& b = bounds_[label];
  b = {std::min(b.left, left),
       std::min(b.top, top),
       std::max(b.right, right),
       std::max(b.bottom, bottom)};
}

void
FaceDescriber::sumPixels(const cv::Mat1f& image,
                         const PixelLabels& pixels,
                         const cv::Rect& part)
{
  for (int v = part.y; v < part.y + part.height; ++v) {
    const short* labels = pixels.row(v);
    const float* depth = image[v];
    for (int u = part.x; u < part.x + part.width;) {
      const short label = labels[u];
      const int first = u;
      double w = 0, kw = 0, ww = 0;
      for (; u < part.x + part.width && labels[u] == label; ++u) {
        const double d = depth[u];
        w += d;
        kw += (u - first) * d;
        ww += d * d;
      }
      if (label <= 0)
        continue;
      sums_[label].addRun(first, v, u - first, w, kw, ww);
      extend(label, first, v, u - 1, v);
    }
  }
}

// A cell that several faces share, or that is not labelled throughout.
void
FaceDescriber::sumMixedCell(const cv::Mat1f& image,
                            const PixelLabels& pixels,
                            int column,
                            int row)
{
  constexpr int size = CellGrid::size, count = size * size;
  const int left = size * column, top = size * row;
  std::array<int, count> labels{};
  std::array<float, count> depth{};
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      labels[size * y + x] = pixels.row(top + y)[left + x];
      depth[size * y + x] = image[top + y][left + x];
    }
  int done = 0; // bits of pixels that have been added
  for (int first = 0; first < count; ++first) {
    const int label = labels[first];
    if (label <= 0 || (done >> first & 1) != 0)
      continue;
    // those of one label, the others count as not measured
    std::array<float, count> d{};
    int found = 0;
    for (int i = 0; i < count; ++i) {
      d[i] = labels[i] == label ? depth[i] : 0.0F;
      found |= (labels[i] == label ? 1 : 0) << i;
    }
    done |= found;
    std::array<double, size> w{}, vw{}, ww{};
    for (int x = 0; x < size; ++x) {
      const double a = d[x], b = d[size + x], c = d[2 * size + x], e = d[3 * size + x];
      w[x] = (a + b) + (c + e);
      vw[x] = b + 2 * c + 3 * e;
      ww[x] = (a * a + b * b) + (c * c + e * e);
    }
    const PositionSums p = CellGrid::positions(static_cast<std::uint16_t>(found));
    const double sum_w = (w[0] + w[1]) + (w[2] + w[3]), u = left, v = top;
    PlaneMoments& m = sums_[label];
    m.n += p.n;
    m.u += p.u + p.n * u;
    m.v += p.v + p.n * v;
    m.uu += p.uu + (2 * p.u + p.n * u) * u;
    m.uv += p.uv + p.u * v + (p.v + p.n * v) * u;
    m.vv += p.vv + (2 * p.v + p.n * v) * v;
    m.w += sum_w;
    m.uw += w[1] + 2 * w[2] + 3 * w[3] + u * sum_w;
    m.vw += (vw[0] + vw[1]) + (vw[2] + vw[3]) + v * sum_w;
    m.ww += (ww[0] + ww[1]) + (ww[2] + ww[3]);
    extendTo(static_cast<short>(label), static_cast<unsigned>(found), left, top);
  }
}

// By the pixels of a cell that are set.
void
FaceDescriber::extendTo(short label, unsigned found, int left, int top)
{
  constexpr unsigned row = 0xf, column = 0x1111; // of a cell's bits
  constexpr int last = CellGrid::size - 1;
  int x0 = 0, x1 = last, y0 = 0, y1 = last;
  while ((found & column << x0) == 0)
    ++x0;
  while ((found & column << x1) == 0)
    --x1;
  while ((found & row << (CellGrid::size * y0)) == 0)
    ++y0;
  while ((found & row << (CellGrid::size * y1)) == 0)
    --y1;
  extend(label, left + x0, top + y0, left + x1, top + y1);
}

// Cells that belong to one face as a whole have their sums already.
void
FaceDescriber::sumCellRow(const cv::Mat1f& image,
                          const CellGrid& grid,
                          const PixelLabels& pixels,
                          int row)
{
  constexpr int size = CellGrid::size;
  static_assert(size == 4, "four labels are compared at once");
  const int top = size * row, cell = grid.index(0, row);
  const short* first = pixels.row(top);
  const int down = pixels.stride();
  for (int c = 0; c < grid.columns; ++c) {
    const short* labels = first + size * c;
    const short label = labels[0];
    const std::uint64_t same = fourTimes(label);
    const bool whole =
        fourLabels(labels) == same && fourLabels(labels + down) == same &&
        fourLabels(labels + 2 * down) == same && fourLabels(labels + 3 * down) == same;
    const int left = size * c;
    if (!whole) {
      sumMixedCell(image, pixels, c, row);
      continue;
    }
    if (label <= 0)
      continue;
    wholes_[label].add(grid.cells[cell + c], c, row);
    extend(label, left, top, left + size - 1, top + size - 1);
  }
}

void
FaceDescriber::describe(const cv::Mat1f& image,
                        const CellGrid& grid,
                        const PixelLabels& pixels,
                        std::size_t regions,
                        const InverseDepthNoise& noise,
                        const Intrinsics& camera,
                        int min_pixels,
                        cv::Mat1s& labels,
                        std::vector<PlanarFace>& faces)
{
  constexpr int far = std::numeric_limits<int>::max();
  sums_.assign(regions + 1, {});
  bounds_.assign(regions + 1, {far, far, -1, -1});
  number_.assign(regions + 1, 0);
  wholes_.assign(regions + 1, {});
  const int right = CellGrid::size * grid.columns, bottom = CellGrid::size * grid.rows;
  for (int row = 0; row < grid.rows; ++row)
    sumCellRow(image, grid, pixels, row);
  sumPixels(image, pixels, {right, 0, image.cols - right, bottom});
  sumPixels(image, pixels, {0, bottom, image.cols, image.rows - bottom});
  for (std::size_t label = 1; label <= regions; ++label) {
    PlanarFace face;
    sums_[label] += wholes_[label].moments();
    if (sums_[label].n < min_pixels || !toFace(sums_[label], noise, camera, face))
      continue;
    const Bounds& b = bounds_[label];
    face.box = cv::Rect(b.left, b.top, b.right - b.left + 1, b.bottom - b.top + 1);
    faces.push_back(face);
    number_[label] = static_cast<short>(faces.size());
  }
  number(pixels, labels);
}

// Labels without gaps, 0 where there is no face.
void
FaceDescriber::number(const PixelLabels& pixels, cv::Mat1s& labels) const
{
  constexpr int word = 4;
  const auto numberOf = [&](short label) { return number_[std::max(label, short{0})]; };
  std::uint64_t last = 0, last_number = 0; // mostly four alike follow four alike
  for (int v = 0; v < labels.rows; ++v) {
    const short* in = pixels.row(v);
    short* out = labels[v];
    int u = 0;
    for (; u + word <= labels.cols; u += word) {
      const std::uint64_t four = fourLabels(in + u);
      if (four != last) {
        std::array<short, word> numbers{};
        for (int k = 0; k < word; ++k)
          numbers[k] = numberOf(in[u + k]);
        last = four;
        last_number = fourLabels(numbers.data());
      }
      std::memcpy(out + u, &last_number, sizeof(last_number));
    }
    for (; u < labels.cols; ++u)
      out[u] = numberOf(in[u]);
  }
}

} // namespace detail
} // namespace hoist
