#include "planar_faces_regions.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hoist {
namespace detail {

struct CellRegions::Test {
  float a, b, c;                       // plane
  float constant, linear, square;      // noise
  float mean_tolerance, rms_tolerance; // squared

  Test(const Eigen::Vector3d& plane,
       const InverseDepthNoise& noise,
       const PlanarFaceParameters& parameters)
  : a(static_cast<float>(plane[0]))
  , b(static_cast<float>(plane[1]))
  , c(static_cast<float>(plane[2]))
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
  operator()(const CellGrid& grid, int cell, int column, int row) const
  {
    constexpr float size = CellGrid::size;
    const CellGrid::Cell& m = grid.cells[cell];
    float mu = (size - 1) / 2, mv = mu, uu = (size * size - 1) / 12, uv = 0, vv = uu;
    if (grid.measured[cell] != CellGrid::full) {
      const PositionSums p = CellGrid::positions(grid.measured[cell]);
      const float part = 1 / static_cast<float>(p.n);
      mu = static_cast<float>(p.u) * part;
      mv = static_cast<float>(p.v) * part;
      uu = static_cast<float>(p.uu) * part - mu * mu;
      uv = static_cast<float>(p.uv) * part - mu * mv;
      vv = static_cast<float>(p.vv) * part - mv * mv;
    }
    const float u = size * static_cast<float>(column) + mu;
    const float v = size * static_cast<float>(row) + mv;
    const float mean = m.w - (a * u + b * v + c);
    const float sigma = constant + m.w * (linear + m.w * square);
    const float unit = sigma * sigma, off = mean * mean;
    const float rms =
        off + m.ww + a * (a * uu + 2 * (b * uv - m.uw)) + b * (b * vv - 2 * m.vw);
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
      if (CellGrid::positions(grid.measured[cell]).n < CellGrid::min_pixels)
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
  members_.clear();
  const auto visit = [&](int cell, int column, int row) {
    if (last_round_[cell] >= round_)
      return;
    last_round_[cell] = round_;
    if (test(grid, cell, column, row))
      members_.push_back({cell, column, row});
  };
  for (int y = window.row; y < window.row + window.height; ++y)
    for (int x = window.column; x < window.column + window.width; ++x)
      visit(grid.index(x, y), x, y);
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const Member m = members_[i];
    visit(m.cell - 1, m.column - 1, m.row);
    visit(m.cell + 1, m.column + 1, m.row);
    visit(m.cell - grid.stride, m.column, m.row - 1);
    visit(m.cell + grid.stride, m.column, m.row + 1);
  }
}

PlaneMoments
CellRegions::sumOfMembers(const CellGrid& grid) const
{
  PlaneMoments sum;
  FullCellSums whole;
  for (const Member& m : members_)
    if (grid.measured[m.cell] == CellGrid::full)
      whole.add(grid.cells[m.cell], m.column, m.row);
    else
      sum += grid.moments({m.column, m.row, 1, 1});
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
    if (members_.size() <= last)
      break;
    last = members_.size();
  }
  planes.push_back(plane);
  sums.push_back(sum);
  for (const Member& m : members_) {
    owner[m.cell] = static_cast<short>(planes.size());
    last_round_[m.cell] = never;
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
    if (owner[cell] <= 0 || owner[other] <= 0 || owner[cell] == owner[other])
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
  for (int r = 0; r < grid.rows; ++r)
    for (int c = 0; c < grid.columns; ++c) {
      const int cell = grid.index(c, r);
      tryMerge(cell, cell + 1);
      tryMerge(cell, cell + grid.stride);
    }
  for (short& o : owner)
    if (o > 0)
      o = root(o);
}

} // namespace detail
} // namespace hoist
