#include "planar_faces_regions.h"

#include "planar_faces_marks.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hoist {
namespace detail {

struct CellRegions::Test {
  float a, b, c;                       // plane by pixel
  float cell_a, cell_b, cell_c;        // plane in the middle of a cell, by cell
  float within;                        // mean square of the plane within a full cell
  float constant, linear, square;      // noise
  float mean_tolerance, rms_tolerance; // squared

  Test(const Eigen::Vector3d& plane,
       const InverseDepthNoise& noise,
       const PlanarFaceParameters& parameters)
  : a(static_cast<float>(plane[0]))
  , b(static_cast<float>(plane[1]))
  , c(static_cast<float>(plane[2]))
  , cell_a(CellGrid::size * a)
  , cell_b(CellGrid::size * b)
  , cell_c(static_cast<float>(plane[2] +
                              (CellGrid::size - 1) / 2.0 * (plane[0] + plane[1])))
  , within((CellGrid::size * CellGrid::size - 1) / 12.0F * (a * a + b * b))
  , constant(static_cast<float>(noise.constant))
  , linear(static_cast<float>(noise.linear))
  , square(static_cast<float>(noise.square))
  , mean_tolerance(
        static_cast<float>(parameters.mean_tolerance * parameters.mean_tolerance))
  , rms_tolerance(
        static_cast<float>(parameters.rms_tolerance * parameters.rms_tolerance))
  {
  }

  bool
  full(const CellGrid::Cell& m, int column, int row) const
  {
    const float at =
        cell_a * static_cast<float>(column) + cell_b * static_cast<float>(row) + cell_c;
    return passes(m, at, within);
  }

  bool
  partial(const CellGrid::Cell& m, std::uint16_t measured, int column, int row) const
  {
    constexpr float size = CellGrid::size;
    const PositionSums p = CellGrid::positions(measured);
    const float part = 1 / static_cast<float>(p.n);
    const float mu = static_cast<float>(p.u) * part;
    const float mv = static_cast<float>(p.v) * part;
    const float uu = static_cast<float>(p.uu) * part - mu * mu;
    const float uv = static_cast<float>(p.uv) * part - mu * mv;
    const float vv = static_cast<float>(p.vv) * part - mv * mv;
    const float u = size * static_cast<float>(column) + mu;
    const float v = size * static_cast<float>(row) + mv;
    return passes(m, a * u + b * v + c, a * (a * uu + 2 * b * uv) + b * b * vv);
  }

private:
  bool
  passes(const CellGrid::Cell& m, float at, float spread) const
  {
    const float mean = m.w - at, off = mean * mean;
    const float rms = off + m.ww + spread - 2 * (a * m.uw + b * m.vw);
    const float sigma = constant + m.w * (linear + m.w * square);
    const float unit = sigma * sigma;
    return off <= mean_tolerance * unit && rms <= rms_tolerance * unit;
  }
};

void
CellRegions::find(const CellGrid& grid,
                  const InverseDepthNoise& noise,
                  const PlanarFaceParameters& parameters,
                  FlatWindows& windows)
{
  noise_ = noise;
  parameters_ = parameters;
  planes.clear();
  sums.clear();
  owner.assign(grid.measured.size(), -1);
  last_round_.assign(grid.measured.size(), never);
  round_ = 0;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const int cell = grid.index(column, row);
      if (!grid.isFull(cell) &&
          CellGrid::positions(grid.measured[cell]).n < CellGrid::min_pixels)
        continue;
      owner[cell] = 0;
      last_round_[cell] = 0;
    }
  constexpr int sizes[][2] = {{4, 4}, {2, 2}, {4, 1}, {1, 4}};
  for (const auto& s : sizes) {
    windows.collect(grid, noise, owner, s[0], s[1]);
    for (int bin = 0; bin < FlatWindows::bins; ++bin)
      for (const FlatWindows::Seed& seed : windows.bin(bin, grid, owner)) {
        if (planes.size() >= max_regions)
          break;
        growFrom({seed.column, seed.row, s[0], s[1]}, grid);
      }
  }
  mergeNeighbours(grid);
}

// Collects the cells that pass the test and hang together with the window.
void
CellRegions::flood(const CellWindow& window, const CellGrid& grid, const Test& test)
{
  ++round_;
  members_.resize(grid.cells.size()); // room for all, so that adding is a store
  Member* end = members_.data();
  int* last_round = last_round_.data();
  const auto visit = [&, round = round_](int cell, int column, int row) {
    if (last_round[cell] >= round)
      return;
    last_round[cell] = round;
    const CellGrid::Cell& m = grid.cells[cell];
    if (grid.isFull(cell) ? test.full(m, column, row)
                          : test.partial(m, grid.measured[cell], column, row))
      *end++ = {cell, column, row};
  };
  for (int y = window.row; y < window.row + window.height; ++y)
    for (int x = window.column; x < window.column + window.width; ++x)
      visit(grid.index(x, y), x, y);
  for (const Member* next = members_.data(); next != end; ++next) {
    const Member m = *next;
    visit(m.cell - 1, m.column - 1, m.row);
    visit(m.cell + 1, m.column + 1, m.row);
    visit(m.cell - grid.stride, m.column, m.row - 1);
    visit(m.cell + grid.stride, m.column, m.row + 1);
  }
  count_ = static_cast<std::size_t>(end - members_.data());
}

PlaneMoments
CellRegions::sumOfMembers(const CellGrid& grid) const
{
  PlaneMoments sum;
  FullCellSums whole;
  for (std::size_t i = 0; i < count_; ++i) {
    const Member& m = members_[i];
    if (grid.isFull(m.cell))
      whole.add(grid.cells[m.cell], m.column, m.row);
    else
      sum += CellGrid::moments(grid.cells[m.cell],
                               CellGrid::positions(grid.measured[m.cell]),
                               m.column,
                               m.row);
  }
  sum += whole.moments();
  return sum;
}

bool
CellRegions::growFrom(const CellWindow& window, const CellGrid& grid)
{
  for (int y = window.row; y < window.row + window.height; ++y)
    for (int x = window.column; x < window.column + window.width; ++x)
      if (owner[grid.index(x, y)] != 0)
        return false;
  PlaneMoments sum = grid.moments(window);
  Eigen::Vector3d plane;
  if (!sum.fit(plane))
    return false;
  // Grow with the seed's plane, fit, and grow again from scratch until it settles: the
  // first plane of a small window is too rough to reach the ends of a large face.
  constexpr int rounds = 4;
  std::size_t last = 0;
  for (int round = 0; round < rounds; ++round) {
    flood(window, grid, Test(plane, noise_, parameters_));
    sum = sumOfMembers(grid);
    if (sum.n < parameters_.min_pixels / 2.0 || !sum.fit(plane))
      return false;
    if (count_ <= last)
      break;
    last = count_;
  }
  planes.push_back(plane);
  sums.push_back(sum);
  for (std::size_t i = 0; i < count_; ++i) {
    owner[members_[i].cell] = static_cast<short>(planes.size());
    last_round_[members_[i].cell] = never;
  }
  return true;
}

// Whether each of two regions lies on their common plane.
bool
CellRegions::fitTogether(int a, int b, PlaneMoments& sum, Eigen::Vector3d& plane) const
{
  sum = sums[a - 1];
  sum += sums[b - 1];
  if (!sum.fit(plane))
    return false;
  for (const int r : {a, b}) {
    const PlaneMoments& m = sums[r - 1];
    double mean = 0, square = 0, own_mean = 0, own_square = 0;
    m.residual(plane, mean, square);
    m.residual(planes[r - 1], own_mean, own_square);
    const double s = noise_(m.w / m.n);
    constexpr double max_mean = 1.2, max_growth = 1.0; // [sigma], variance [sigma^2]
    if (std::abs(mean) > max_mean * s || square - own_square > max_growth * s * s)
      return false;
  }
  return true;
}

void
CellRegions::mergeNeighbours(const CellGrid& grid)
{
  parent_.resize(planes.size() + 1);
  std::iota(parent_.begin(), parent_.end(), short{0});
  const auto root = [&](short r) {
    while (parent_[r] != r)
      r = parent_[r];
    return r;
  };
  // along a border the same two meet again and again
  short last_a = 0, last_b = 0;
  const auto tryMerge = [&](int cell, int other) {
    if (owner[cell] == owner[other] || owner[cell] <= 0 || owner[other] <= 0)
      return;
    const short a = root(owner[cell]), b = root(owner[other]);
    if (a == b || (a == last_a && b == last_b))
      return;
    last_a = a;
    last_b = b;
    PlaneMoments sum;
    Eigen::Vector3d plane;
    if (!fitTogether(a, b, sum, plane))
      return;
    last_a = last_b = 0;
    const short keep = std::min(a, b), drop = std::max(a, b);
    parent_[drop] = keep;
    sums[keep - 1] = sum;
    planes[keep - 1] = plane;
  };
  resizeMarks(marks_, grid.columns);
  for (int r = 0; r < grid.rows; ++r) {
    const int first = grid.index(0, r);
    const short *here = &owner[first], *below = here + grid.stride;
    short* mark = marks_.data();
    for (int c = 0; c < grid.columns; ++c)
      mark[c] = here[c] > 0 ? (here[c] ^ here[c + 1]) | (here[c] ^ below[c]) : 0;
    forEachMark(marks_, grid.columns, [&](int c) {
      tryMerge(first + c, first + c + 1);
      tryMerge(first + c, first + c + grid.stride);
    });
  }
  for (short& o : owner)
    if (o > 0)
      o = root(o);
}

} // namespace detail
} // namespace hoist
