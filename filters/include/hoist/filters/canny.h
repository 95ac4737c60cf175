#pragma once

#include <hoist/filters/export.h>
#include <hoist/filters/texture_remover.h>

#include <opencv2/core.hpp>

#include <vector>

namespace hoist {

/** \brief Settings of \ref Canny. Gradients are of 8 bit grey images, Sobel 3 x 3, so a
 *  sharp step of contrast c has magnitude 4 c before blurring. */
struct CannyParameters {
  double blur_sigma = 1.0; ///< Gaussian before the gradient [px], 0 = none, <= 5

  bool auto_threshold = true; ///< choose the thresholds from the image
  double high = 120;          ///< without auto: a contour needs one such pixel, > 0
  double low = 48;            ///< without auto: a contour goes on above it, <= high

  double edge_share = 0.06;  ///< auto: share of pixels above high, in (0, 1)
  double noise_factor = 6.0; ///< auto: high is at least this times the median magnitude
  double low_ratio = 0.4;    ///< auto: low = low_ratio * high, in (0, 1]

  /// Multiplies both thresholds, chosen or given: the knob of the paper's circular
  /// process (Figure 4). Below 1 finds more contours, above 1 fewer; > 0.
  double threshold_scale = 1.0;

  bool remove_texture = true;    ///< drop clustered contours that are print
  int texture_window = 0;        ///< side of the clutter window [px]; 0: width / 40
  double texture_density = 0.12; ///< share of clutter pixels that makes it texture
  double straight_length = 0;    ///< runs this long are edges [px]; 0: width / 32
};

/** \brief Improved Canny (paper 4.2.1): thresholds that adjust themselves, and removal
 *  of clustered contour points that are texture and not edges.
 *
 * The thresholds: with M the gradient magnitudes of the image,
 *   high = max(quantile(M, 1 - edge_share), noise_factor * median(M)),
 *   low = low_ratio * high, both times threshold_scale.
 * The first term adapts to the contrast of the scene, the second keeps noise out of
 * scenes with little contrast.
 *
 * The texture rule (idea of the paper's Figure 5):
 *  1. contour pixels are grouped into straight runs: 8-connected pixels whose gradient
 *     stays within 22.5 degrees of the run's mean direction; runs that continue each
 *     other over a gap of a few pixels (print touches the edge there) are joined;
 *  2. pixels of runs shorter than straight_length are clutter;
 *  3. where the share of clutter pixels in a window reaches texture_density there is
 *     texture; clutter in any such window is removed. (Windows lie on a grid of a
 *     quarter of their side.)
 * A long straight edge is never clutter, and does not count towards the density, so it
 * survives a texture that it crosses or borders; a lone short or curved contour stays,
 * because nothing is clustered around it.
 *
 * Holds buffers that are reused while the image size stays; not thread safe, use one
 * per thread. Apart from OpenCV's filters and cv::Canny nothing is allocated after the
 * first image.
 */
class HOIST_FILTERS_EXPORT Canny {
public:
  /** \brief Computes the gradients of an image; call once per image.
   *
   * \param gray 8 bit, any size; read only during the call
   * \param blur_sigma see CannyParameters
   */
  void setImage(const cv::Mat1b& gray,
                double blur_sigma = CannyParameters().blur_sigma);

  /** \brief Contours of the image; may be called again with other thresholds.
   *
   * \param edges 255 on a contour, else 0; the image's size; the outermost pixels are
   *        never contours. Empty if no image was set
   * \throws std::invalid_argument on a parameter outside its range
   */
  void detect(const CannyParameters& parameters, cv::Mat1b& edges);

  /** \brief Upper threshold that the last detect() used, 0 before. */
  double
  getHighThreshold() const
  {
    return high_;
  }

  /** \brief Lower threshold that the last detect() used, 0 before. */
  double
  getLowThreshold() const
  {
    return low_;
  }

  /** \brief Gradient images of the last image, CV_16S. */
  const cv::Mat1s&
  getGradientX() const
  {
    return dx_;
  }

  const cv::Mat1s&
  getGradientY() const
  {
    return dy_;
  }

private:
  void chooseThresholds(const CannyParameters& parameters);

  cv::Mat1b blurred_;
  cv::Mat1s dx_, dy_;
  std::vector<int> histogram_;
  TextureRemover texture_;
  double high_ = 0, low_ = 0;
};

} // namespace hoist
