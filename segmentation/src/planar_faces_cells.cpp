#include "planar_faces_cells.h"

#include <array>

namespace hoist {
namespace detail {
namespace {

constexpr int size = CellGrid::size;

// For two rows of a cell, by their eight bits.
constexpr std::array<PositionSums, 256>
positionsOfTwoRows()
{
  std::array<PositionSums, 256> sums{};
  for (int bits = 0; bits < 256; ++bits)
    for (int k = 0; k < 8; ++k)
      if ((bits >> k & 1) != 0) {
        const int u = k % size, v = k / size;
        PositionSums& s = sums[bits];
        s.n += 1;
        s.u += u;
        s.v += v;
        s.uu += u * u;
        s.uv += u * v;
        s.vv += v * v;
      }
  return sums;
}

constexpr std::array<PositionSums, 256> two_rows = positionsOfTwoRows();

constexpr PositionSums
positionSums(unsigned measured)
{
  const PositionSums &a = two_rows[measured & 0xffU], &b = two_rows[measured >> 8];
  PositionSums sums;
  sums.n = a.n + b.n;
  sums.u = a.u + b.u;
  sums.v = a.v + b.v + 2 * b.n; // two rows further down
  sums.uu = a.uu + b.uu;
  sums.uv = a.uv + b.uv + 2 * b.u;
  sums.vv = a.vv + b.vv + 4 * b.v + 4 * b.n;
  return sums;
}

constexpr PositionSums of_full = positionSums(CellGrid::full);

} // namespace

PositionSums
CellGrid::positions(std::uint16_t measured)
{
  return measured == full ? of_full : positionSums(measured);
}

void
CellGrid::assign(const cv::Mat1f& inverse_depth)
{
  columns = inverse_depth.cols / size;
  rows = inverse_depth.rows / size;
  stride = columns + 1;
  const std::size_t count = static_cast<std::size_t>(rows + 2) * stride + 1;
  measured.assign(count, 0);
  cells.assign(count, Cell{});
  const std::size_t width = static_cast<std::size_t>(columns) * size;
  column_w_.resize(width);
  column_vw_.resize(width);
  column_ww_.resize(width);
  column_measured_.resize(width);
  for (int row = 0; row < rows; ++row) {
    sumColumns(inverse_depth, row);
    for (int column = 0; column < columns; ++column)
      sumCell(index(column, row), column);
  }
}

void
CellGrid::sumColumns(const cv::Mat1f& image, int row)
{
  const float* r0 = image[size * row];
  const float* r1 = image[size * row + 1];
  const float* r2 = image[size * row + 2];
  const float* r3 = image[size * row + 3];
  double* sw = column_w_.data();
  double* svw = column_vw_.data();
  double* sww = column_ww_.data();
  int* bits = column_measured_.data();
  const int width = columns * size;
  for (int u = 0; u < width; ++u) {
    const double w0 = r0[u], w1 = r1[u], w2 = r2[u], w3 = r3[u];
    sw[u] = (w0 + w1) + (w2 + w3);
    svw[u] = w1 + 2 * w2 + 3 * w3;
    sww[u] = (w0 * w0 + w1 * w1) + (w2 * w2 + w3 * w3);
  }
  for (int u = 0; u < width; ++u)
    bits[u] = (r0[u] > 0 ? 0x1 : 0) | (r1[u] > 0 ? 0x10 : 0) | (r2[u] > 0 ? 0x100 : 0) |
              (r3[u] > 0 ? 0x1000 : 0);
}

void
CellGrid::sumCell(int cell, int column)
{
  const int first = column * size;
  const int* bits = &column_measured_[first];
  const int found = bits[0] | bits[1] << 1 | bits[2] << 2 | bits[3] << 3;
  if (found == 0)
    return;
  const double* s = &column_w_[first];
  const double* sv = &column_vw_[first];
  const double* ss = &column_ww_[first];
  const double sw = (s[0] + s[1]) + (s[2] + s[3]);
  const double suw = s[1] + 2 * s[2] + 3 * s[3];
  const double svw = (sv[0] + sv[1]) + (sv[2] + sv[3]);
  const double sww = (ss[0] + ss[1]) + (ss[2] + ss[3]);
  measured[cell] = static_cast<std::uint16_t>(found);
  double part = 1.0 / (size * size), mu = (size - 1) / 2.0, mv = mu;
  if (found != full) {
    const PositionSums p = positionSums(static_cast<unsigned>(found));
    part = 1.0 / p.n;
    mu = p.u * part;
    mv = p.v * part;
  }
  const double mw = sw * part;
  cells[cell] = {static_cast<float>(mw),
                 static_cast<float>(suw * part - mu * mw),
                 static_cast<float>(svw * part - mv * mw),
                 static_cast<float>(sww * part - mw * mw)};
}

PlaneMoments
CellGrid::moments(const CellWindow& window) const
{
  FullCellSums whole;
  PlaneMoments sum;
  for (int y = window.row; y < window.row + window.height; ++y)
    for (int x = window.column; x < window.column + window.width; ++x) {
      const int cell = index(x, y);
      if (isFull(cell))
        whole.add(cells[cell], x, y);
      else if (measured[cell] != 0)
        sum += moments(cells[cell], positions(measured[cell]), x, y);
    }
  if (whole.n > 0)
    sum += whole.moments();
  return sum;
}

PlaneMoments
CellGrid::moments(const Cell& cell, const PositionSums& p, int column, int row)
{
  const double u = column * size, v = row * size;
  const double pu = p.u + p.n * u, pv = p.v + p.n * v, w = cell.w;
  PlaneMoments sum;
  sum.n = p.n;
  sum.u = pu;
  sum.v = pv;
  sum.uu = p.uu + (p.u + pu) * u;
  sum.uv = p.uv + p.u * v + pv * u;
  sum.vv = p.vv + (p.v + pv) * v;
  sum.w = p.n * w;
  sum.uw = p.n * static_cast<double>(cell.uw) + pu * w;
  sum.vw = p.n * static_cast<double>(cell.vw) + pv * w;
  sum.ww = p.n * (cell.ww + w * w);
  return sum;
}

PlaneMoments
FullCellSums::moments() const
{
  // pixel k of cell x lies at size x + k
  constexpr double s = size, pixels = s * s;
  constexpr double k = of_full.u, kk = of_full.uu, kl = of_full.uv, mean = k / pixels;
  PlaneMoments m;
  m.n = pixels * n;
  m.u = pixels * s * x + k * n;
  m.v = pixels * s * y + k * n;
  m.uu = pixels * s * s * xx + 2 * k * s * x + kk * n;
  m.uv = pixels * s * s * xy + k * s * (x + y) + kl * n;
  m.vv = pixels * s * s * yy + 2 * k * s * y + kk * n;
  m.w = pixels * w;
  m.uw = pixels * (uw + s * xw + mean * w);
  m.vw = pixels * (vw + s * yw + mean * w);
  m.ww = pixels * ww;
  return m;
}

} // namespace detail
} // namespace hoist
