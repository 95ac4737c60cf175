#pragma once

#include <hoist/data/frame_images.h>
#include <hoist/filters/canny.h>
#include <hoist/filters/depth_edges.h>
#include <hoist/filters/edge_kind.h>
#include <hoist/filters/export.h>

#include <opencv2/core.hpp>

namespace hoist {

/** \brief Settings of \ref EdgeDetector. */
struct EdgeParameters {
  int kinds = EDGE_ALL; ///< wanted EdgeKind flags
  CannyParameters canny;
  DepthEdgeParameters depth;
  int near_side_radius = 3; ///< see EdgeDetector, [px], 0 ... 16; 0 = do not move
};

/** \brief All edge pixels of a frame with their kinds; the numerics of \ref EdgePixels.
 *
 * Invalid depth is handled on the near side: the colour image and the depth image of a
 * silhouette disagree by a few pixels, so a contour pixel there may have no depth, or
 * the background's. With near_side_radius r > 0 a contour pixel
 *  - that is unmeasured, or lies farther by more than step_sigmas sigmas than a near
 *    side pixel of a depth step at most r away, moves to the nearest such pixel;
 *  - that is unmeasured, with no such step around, moves to the nearest measured pixel
 *    (the nearer surface where two are equally near in the image);
 *  - that is unmeasured, with nothing measured around, is dropped.
 * With r = 0 unmeasured contour pixels are dropped and all others stay.
 *
 * Holds buffers that are reused while the frame size stays; not thread safe.
 */
class HOIST_FILTERS_EXPORT EdgeDetector {
public:
  /** \brief Finds the edge pixels of a frame.
   *
   * \param images the frame; without colour there are no colour edges, without valid
   *        intrinsics no creases
   * \param labels EdgeKind flags, the frame's size; set only where the point is
   * measured \throws std::invalid_argument on a parameter outside its range
   */
  void detect(const FrameImages& images,
              const EdgeParameters& parameters,
              cv::Mat1b& labels);

  /** \brief Finds the colour edges of the last frame again, with other thresholds.
   *
   * The gradients and the depth edges are kept: this is what one turn of the paper's
   * circular process (Figure 4) costs. The frame's buffers must still hold the frame.
   *
   * \param parameters as in detect(); only canny (not its blur) and near_side_radius
   * may differ
   */
  void redetect(const EdgeParameters& parameters, cv::Mat1b& labels);

  /** \brief Contours of the last call, before they were moved to the near side; empty
   *  without colour. */
  const cv::Mat1b&
  getContours() const
  {
    return contours_;
  }

  const Canny&
  getCanny() const
  {
    return canny_;
  }

private:
  Canny canny_;
  DepthEdges depth_edges_;
  bool has_color_ = false;
  cv::Mat1f inverse_depth_; // of the last frame, shared
  cv::Mat1b contours_, depth_labels_;
};

/** \brief Or-s EDGE_COLOR into \a labels for all contours, moved to the near side.
 *
 * \param contours non-zero on contours
 * \param inverse_depth 1 / z [1/m], 0 where not measured
 * \param steps DepthEdges::StepSide flags
 * \param parameters depth and near_side_radius are used
 */
HOIST_FILTERS_EXPORT void addContours(const cv::Mat1b& contours,
                                      const cv::Mat1f& inverse_depth,
                                      const cv::Mat1b& steps,
                                      const EdgeParameters& parameters,
                                      cv::Mat1b& labels);

} // namespace hoist
