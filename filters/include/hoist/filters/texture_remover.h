#pragma once

#include <hoist/filters/export.h>

#include <opencv2/core.hpp>

#include <cstdint>
#include <vector>

namespace hoist {

/** \brief Settings of \ref TextureRemover. */
struct TextureParameters {
  int window = 16;             ///< side of the clutter window [px], > 0
  double density = 0.12;       ///< share of clutter pixels that is texture, in (0, 1]
  double straight_length = 20; ///< straight runs this long are edges [px], >= 0
};

/** \brief Removes clustered contour points that are texture; the rule is told at
 *  \ref Canny.
 *
 * Its cost follows the number of contour pixels. Reuses its buffers; not thread safe.
 */
class HOIST_FILTERS_EXPORT TextureRemover {
public:
  /** \param dx, dy gradient images, continuous, the size of \a edges
   *  \param edges contours: 255, else 0, continuous, with a clear border one pixel
   * wide; texture is set to 0 */
  void remove(const cv::Mat1s& dx,
              const cv::Mat1s& dy,
              const TextureParameters& parameters,
              cv::Mat1b& edges);

private:
  // A straight run of contour pixels: pixels_[begin .. end).
  struct Run {
    int begin = 0, end = 0;
    float u = 0, v = 0;        // a point on it [px]
    float tu = 0, tv = 0;      // unit tangent, the bright side on its right
    float least = 0, most = 0; // extent along the tangent from (u, v) [px]
    int chain = 0;             // union-find parent

    float
    length() const
    {
      return most - least + 1;
    }
  };

  void growRuns(const cv::Mat1s& dx, const cv::Mat1s& dy, cv::Mat1b& edges);
  void measure(Run& run, int columns, float gx, float gy) const;
  void joinRuns(const cv::Mat1b& edges);
  int root(int run);
  void clearClutter(const TextureParameters& parameters, cv::Mat1b& edges);

  std::vector<int> pixels_; // contour pixels, run after run
  std::vector<Run> runs_;
  std::vector<float> chain_length_; // by run, valid at roots
  cv::Mat1i run_of_pixel_;          // valid where there is a contour
  std::vector<int> cells_, sums_;   // clutter per grid cell, summed over windows
  std::vector<unsigned char> textured_;
};

} // namespace hoist
