#include "planar_faces_pixels.h"

#include "planar_faces_marks.h"

#include <algorithm>
#include <limits>

namespace hoist {
namespace detail {

void
PixelLabels::assign(const cv::Mat1f& image,
                    const CellGrid& grid,
                    const CellRegions& regions,
                    const InverseDepthNoise& noise,
                    double tolerance)
{
  width_ = image.cols;
  height_ = image.rows;
  labels_.resize(static_cast<std::size_t>(height_ + 2) * stride() + 1);
  std::fill_n(row(-1) - 1, stride(), closed);
  for (int v = 0; v <= height_; ++v)
    row(v)[-1] = closed;
  std::fill_n(row(height_), stride(), closed);
  resizeMarks(marks_, width_);

  planes_.resize(regions.planes.size() + 1);
  planes_[0] = {0, 0, std::numeric_limits<float>::max(), 0};
  for (std::size_t i = 0; i < regions.planes.size(); ++i) {
    const Eigen::Vector3f p = regions.planes[i].cast<float>();
    planes_[i + 1] = {p[0], p[1], p[2], 0};
  }
  const InverseDepthNoise limit = noise * tolerance;
  limit_ = {static_cast<float>(limit.constant),
            static_cast<float>(limit.linear),
            static_cast<float>(limit.square)};
  labelCells(image, grid, regions);
  findFringe();
  growFringe(image);
  moveCreases(image);
}

void
PixelLabels::labelCells(const cv::Mat1f& image,
                        const CellGrid& grid,
                        const CellRegions& regions)
{
  constexpr int size = CellGrid::size;
  for (int r = 0; r < grid.rows; ++r) {
    const cv::Range rows(size * r, size * (r + 1));
    const short* owner = &regions.owner[grid.index(0, r)];
    for (int c = 0; c < grid.columns;) {
      const short label = std::max(owner[c], short{0});
      const int first = c;
      while (c < grid.columns && std::max(owner[c], short{0}) == label)
        ++c;
      labelRun(image, rows, {size * first, size * c}, label);
    }
    labelRun(image, rows, {size * grid.columns, width_}, 0);
  }
  labelRun(image, {size * grid.rows, height_}, {0, width_}, 0);
}

void
PixelLabels::labelRun(const cv::Mat1f& image,
                      const cv::Range& rows,
                      const cv::Range& columns,
                      short label)
{
  const Plane plane = planes_[label];
  const Limit limit = limit_;
  for (int v = rows.start; v < rows.end; ++v) {
    const float* w = image[v];
    short* out = row(v);
    if (label == 0) {
      for (int u = columns.start; u < columns.end; ++u)
        out[u] = w[u] > 0 ? short{0} : closed;
      continue;
    }
    const float base = plane.b * static_cast<float>(v) + plane.c;
    for (int u = columns.start; u < columns.end; ++u) {
      const float r = std::abs(w[u] - (plane.a * static_cast<float>(u) + base));
      const short fitting = r < limit(w[u]) ? label : short{0};
      out[u] = w[u] > 0 ? fitting : closed;
    }
  }
}

// Measured pixels without a region beside pixels of one.
void
PixelLabels::findFringe()
{
  queue_.clear();
  short* mark = marks_.data();
  for (int v = 0; v < height_; ++v) {
    const short *here = row(v), *up = row(v - 1), *down = row(v + 1);
    for (int u = 0; u < width_; ++u) {
      const short beside = std::max(here[u - 1], here[u + 1]);
      const short above = std::max(up[u], down[u]);
      mark[u] = here[u] == 0 && std::max(beside, above) > 0 ? 1 : 0;
    }
    forEachMark(marks_, width_, [&](int u) { queue_.push_back({u, v}); });
  }
}

void
PixelLabels::growFringe(const cv::Mat1f& image)
{
  constexpr int layers = 2 * CellGrid::size;
  for (int layer = 0; layer < layers && !queue_.empty(); ++layer) {
    next_.clear();
    for (const Pixel& p : queue_) {
      short* label = row(p.v) + p.u;
      if (*label != 0)
        continue;
      const float w = image(p.v, p.u);
      const Offer best = bestNeighbour(label, p, w, {0, limit_(w)});
      if (best.label != 0) {
        *label = best.label;
        next_.push_back(p);
      }
    }
    queue_.clear();
    for (const Pixel& p : next_) {
      const short* label = row(p.v) + p.u;
      if (label[-1] == 0)
        queue_.push_back({p.u - 1, p.v});
      if (label[1] == 0)
        queue_.push_back({p.u + 1, p.v});
      if (label[-stride()] == 0)
        queue_.push_back({p.u, p.v - 1});
      if (label[stride()] == 0)
        queue_.push_back({p.u, p.v + 1});
    }
  }
}

} // namespace detail
} // namespace hoist
