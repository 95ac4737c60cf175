#pragma once

#include <hoist/filters/export.h>

#include <opencv2/core.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace hoist {

struct InverseDepthNoise;

/** \brief Settings of \ref CreaseFinder. */
struct CreaseParameters {
  double angle = 0.44; ///< smallest angle between the two surfaces [rad], in (0, pi/2)
  double sigmas = 5;   ///< smallest kink in its own standard deviations, > 0
  double focal = 525;  ///< focal length [px], > 0
};

/** \brief Finds the lines where two surfaces meet, from second differences of the
 *  inverse depth w = 1/z.
 *
 * A plane is linear in w, so along a row or column that crosses a crease at 0,
 *   w(x) = w0 + s x + (k/2) |x|,  k = difference of the two slopes,
 * whatever the angle of view. With the means of the outer blocks L, R and the central
 * block C of a window of 2 d + 1 cells,
 *   k = ((L + R) / 2 - C) * 2 / g(d),
 * g(d) being the same difference for |x|: any linear part cancels. The slopes on both
 * sides, s -+ k/2, give the tangents t = slope * f / w of the surfaces in the plane of
 * the row, and the kink is a crease where the angle between them,
 *   tan = |t1 - t2| / (1 + t1 t2),
 * reaches the wanted one and |k| reaches `sigmas` of its standard deviation. d is the
 * smallest window for which the second follows from the first, so it grows with depth;
 * near steps, gaps and the border it shrinks to what is free.
 *
 * Cells are square blocks of pixels, about 1/262 rad, and bands of five rows are
 * averaged, so the cost does not grow with the resolution beyond the reduction. Local
 * maxima of |k| along the row (and column) over half a window are creases; they are
 * located within the cell by a parabola, linked to their neighbours, and drawn as
 * connected lines. Lines of less than ten cells are noise and are dropped.
 */
class HOIST_FILTERS_EXPORT CreaseFinder {
public:
  /** \param w inverse depth, 0 where not measured
   *  \param noise standard deviation of w as a function of w
   *  \param steps non-zero on pixels at a depth step, which no window crosses
   *  \param flag is or-ed into \a labels along the creases, where w is measured */
  void find(const cv::Mat1f& w,
            const InverseDepthNoise& noise,
            const cv::Mat1b& steps,
            const CreaseParameters& parameters,
            unsigned char flag,
            cv::Mat1b& labels);

private:
  static constexpr int max_reach = 12; // cells
  static constexpr int min_reach = 2;

  struct Window {
    int block = 0;   // cells of an outer block
    int middle = 0;  // the central block has 2 * middle + 1 cells
    float gain = 0;  // k per unit of (L + R) / 2 - C
    float sigma = 0; // standard deviation of k per standard deviation of a cell
    // reciprocals, because they are needed per cell; of fixed point sums to means
    float per_outer = 0, per_middle = 0, per_base = 0, per_sigma = 0;
  };

  // Means of the blocks of a window: (L + R) / 2 - C and R - L.
  struct Blocks {
    float kink, rise;
  };

  void reduce(const cv::Mat1f& w, const cv::Mat1b& steps);
  void chooseWindows(const InverseDepthNoise& noise,
                     const CreaseParameters& parameters);
  // Kinks along the rows of \a cells.
  void findKinks(const cv::Mat1f& cells,
                 const InverseDepthNoise& noise,
                 const CreaseParameters& parameters,
                 cv::Mat1f& kinks);
  // The window of every cell of the band, below min_reach where there is none.
  void chooseReach(int cols);
  Blocks blocksAt(int u, int d) const;
  // Kinks over noise of the cells begin .. end - 1, which share a window.
  void kinksOfWindow(int begin,
                     int end,
                     int d,
                     const InverseDepthNoise& noise,
                     float* out) const;
  void findPeaks();
  void drawPeaks(const cv::Mat1f& w, unsigned char flag, cv::Mat1b& labels);
  void drawLine(cv::Point2f from,
                cv::Point2f to,
                const cv::Mat1f& w,
                unsigned char flag,
                cv::Mat1b& labels) const;

  int factor_ = 1; // pixels per cell
  std::array<Window, max_reach + 1> windows_{};
  std::vector<unsigned char> reach_of_w_; // wanted window by w, see chooseWindows
  float w_to_bin_ = 0;

  cv::Mat1f cells_, cells_turned_; // inverse depth; NaN where not to be used
  cv::Mat1f kinks_, kinks_turned_, kinks_vertical_;
  cv::Mat1b peaks_;
  cv::Mat2f position_; // of a peak [px]
  float to_fixed_ = 0;
  std::vector<float> sum_, count_, band_;
  std::vector<std::uint32_t> prefix_;
  std::vector<int> reach_, stack_;
};

} // namespace hoist
