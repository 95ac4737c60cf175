#pragma once

#include "planar_faces_regions.h"

#include <opencv2/core.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace hoist {
namespace detail {

/** \brief Numbers of regions pixel by pixel. Keeps its buffers.
 *
 * There are unused pixels around the image, so that all neighbours of a pixel exist:
 * see \ref row. A label is the number of a region, 1 and up, 0 for a measured pixel
 * without one, or \ref closed for what can never have one. */
class PixelLabels {
public:
  static constexpr short closed = -1;

  struct Pixel {
    int u, v;
  };

  /// Pixels that stand one after the other.
  struct Range {
    Pixel *first, *last;

    Pixel*
    begin() const
    {
      return first;
    }
    Pixel*
    end() const
    {
      return last;
    }
  };

  int
  width() const
  {
    return width_;
  }
  int
  height() const
  {
    return height_;
  }
  /// From a pixel to the one below.
  int
  stride() const
  {
    return width_ + 1;
  }
  /// Row \a v from -1 to height(), columns from -1 to width().
  short*
  row(int v)
  {
    return labels_.data() + static_cast<std::ptrdiff_t>(v + 1) * stride() + 1;
  }
  const short*
  row(int v) const
  {
    return labels_.data() + static_cast<std::ptrdiff_t>(v + 1) * stride() + 1;
  }

  /** \brief Every measured pixel near a region to the plane it fits: first those of the
   * region's cells, then layer by layer outwards, and where two regions meet each pixel
   * goes to the better one, so that the border lies where the planes intersect. */
  void assign(const cv::Mat1f& inverse_depth,
              const CellGrid& grid,
              const CellRegions& regions,
              const InverseDepthNoise& noise,
              double tolerance);

  /** \brief Connected rests without a break in depth, narrower than a cell but flat or
   * made of up to four flat parts one behind the other, as the strip around the corner
   * of a thin slab, become regions of their own: appended to \a regions.
   *  \param min_pixels smaller rests are left alone */
  void addSlivers(const cv::Mat1f& inverse_depth,
                  const InverseDepthNoise& noise,
                  int min_pixels,
                  CellRegions& regions);

private:
  struct Plane {
    float a, b, c, unused; // of a size that is quick to index
  };
  // Single precision and scaled to the largest residual that is allowed.
  struct Limit {
    float constant, linear, square;

    float
    operator()(float w) const
    {
      return constant + w * (linear + w * square);
    }
  };

  /// What a neighbour's region is to a pixel.
  struct Offer {
    short label;
    float residual;
  };

  // Residual of (u, v, w) from the plane of a label, huge where there is none.
  float
  residual(short label, const Pixel& p, float w) const
  {
    const Plane& plane = planes_[std::max(label, short{0})];
    return std::abs(w - (plane.a * static_cast<float>(p.u) +
                         plane.b * static_cast<float>(p.v) + plane.c));
  }

  // The best of the four neighbours' regions, or the offer made if none is better. No
  // branches: which neighbour it will be cannot be foreseen.
  Offer
  bestNeighbour(const short* label, const Pixel& p, float w, Offer best) const
  {
    for (const short other : {label[-1], label[1], label[-stride()], label[stride()]}) {
      const float r = residual(other, p, w);
      best.label = r < best.residual ? other : best.label;
      best.residual = std::min(r, best.residual);
    }
    return best;
  }

  void
  labelCells(const cv::Mat1f& image, const CellGrid& grid, const CellRegions& regions);
  void labelRun(const cv::Mat1f& image,
                const cv::Range& rows,
                const cv::Range& columns,
                short label);
  void findFringe();
  void growFringe(const cv::Mat1f& image);
  void moveCreases(const cv::Mat1f& image);
  bool settle(const cv::Mat1f& image, const Pixel& p);
  void collectPiece(const cv::Mat1f& image, const Pixel& start);
  void addPiece(const cv::Mat1f& image,
                const InverseDepthNoise& noise,
                const Range& piece,
                int min_pixels,
                int splits,
                CellRegions& regions);

  int width_ = 0, height_ = 0;
  std::vector<short> labels_;
  std::vector<Plane> planes_; // by label; 0 fits nothing
  Limit limit_{};
  std::vector<short> marks_; // pixels of a row to look at
  std::vector<Pixel> queue_, next_;
};

} // namespace detail
} // namespace hoist
