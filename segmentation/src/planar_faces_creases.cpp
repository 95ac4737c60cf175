#include "planar_faces_pixels.h"

#include "planar_faces_marks.h"

namespace hoist {
namespace detail {

// Gives a pixel to the neighbour's region that it fits best. True if it changed.
bool
PixelLabels::settle(const cv::Mat1f& image, const Pixel& p)
{
  short* label = row(p.v) + p.u;
  const short own = *label;
  if (own <= 0)
    return false;
  const float w = image(p.v, p.u);
  *label = bestNeighbour(label, p, w, {own, residual(own, p, w)}).label;
  return *label != own;
}

void
PixelLabels::moveCreases(const cv::Mat1f& image)
{
  next_.clear();
  short* mark = marks_.data();
  for (int v = 0; v < height_; ++v) {
    const short *here = row(v), *up = row(v - 1), *down = row(v + 1);
    const auto differs = [](short other, short own) {
      return static_cast<short>(other > 0 && other != own);
    };
    for (int u = 0; u < width_; ++u) {
      const short own = here[u];
      const short any = differs(here[u - 1], own) | differs(here[u + 1], own) |
                        differs(up[u], own) | differs(down[u], own);
      mark[u] = own > 0 ? any : short{0};
    }
    forEachMark(marks_, width_, [&](int u) {
      if (settle(image, {u, v})) {
        next_.push_back({u, v});
        if (u + 1 < width_)
          mark[u + 1] = 1; // its neighbour is another one now
      }
    });
  }
  // A change is news to the neighbours. A few sweeps reach as far as a cell.
  for (int sweep = 1; sweep < CellGrid::size; ++sweep) {
    queue_ = next_; // no swap: each buffer keeps its own room
    next_.clear();
    for (const Pixel& p : queue_) {
      const short label = row(p.v)[p.u];
      for (const Pixel& q : {Pixel{p.u - 1, p.v},
                             Pixel{p.u + 1, p.v},
                             Pixel{p.u, p.v - 1},
                             Pixel{p.u, p.v + 1}}) {
        short& own = row(q.v)[q.u];
        if (own <= 0 || own == label)
          continue;
        const float w = image(q.v, q.u);
        if (residual(label, q, w) < residual(own, q, w)) {
          own = label;
          next_.push_back(q);
        }
      }
    }
  }
}

} // namespace detail
} // namespace hoist
