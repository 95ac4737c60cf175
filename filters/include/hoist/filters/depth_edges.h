#pragma once

#include <hoist/data/frame_images.h>
#include <hoist/data/sensor_model.h>
#include <hoist/filters/crease_finder.h>
#include <hoist/filters/edge_kind.h>
#include <hoist/filters/export.h>

#include <opencv2/core.hpp>

#include <vector>

namespace hoist {

/** \brief Settings of \ref DepthEdges. */
struct DepthEdgeParameters {
  SensorModel sensor;     ///< all depth thresholds follow its sigmaZ
  double step_sigmas = 5; ///< smallest depth step, in sigmas of the nearer depth, > 0
  int max_gap = 0;        ///< widest gap explained by a shadow [px]; 0: width / 10

  double crease_angle = 0.44; ///< smallest angle between two surfaces [rad], (0, pi/2)
  double crease_sigmas = 5;   ///< and how many sigmas it must stand out, > 0
};

/** \brief The noise of the inverse depth as a quadratic: sigma_w = a + b w + c w^2.
 *
 * w = 1/z, so sigma_w = sigmaZ(z) w^2 to first order; for every SensorModel::Kind this
 * is a quadratic, found here from three depths. Unlike sigmaZ it is cheap on a whole
 * image, and has no pole where nothing was measured (w = 0).
 */
struct InverseDepthNoise {
  float a = 0, b = 0, c = 0;

  HOIST_FILTERS_EXPORT explicit InverseDepthNoise(const SensorModel& sensor);

  float
  operator()(float w) const
  {
    return a + w * (b + w * c);
  }
};

/** \brief Occlusion and crease edges of a depth image.
 *
 * Works on the inverse depth w, in which every plane is a linear function of the pixel.
 *
 * Occlusion edge: between two neighbours p, q of a row or column (next to each other,
 * or with only unmeasured pixels between) w jumps by more than step_sigmas standard
 * deviations, and neither surface, continued linearly over the gap, meets the other.
 * The edge is the pixel with the larger w, the near side: the shadow of unmeasured
 * pixels that a near object throws onto a far one belongs to the far one. A pixel that
 * is at once the far side of another step (mixed pixels between two surfaces) is not an
 * edge. A gap longer than max_gap both along and across the line is no shadow but a
 * void: the surfaces end there, and both its ends are edges. The same holds for
 * unmeasured runs up to the image border. The image border itself is no edge.
 *
 * Crease edge: see CreaseFinder.
 *
 * Holds buffers that are reused while the image size stays (nothing is allocated then);
 * not thread safe, use one per thread.
 */
class HOIST_FILTERS_EXPORT DepthEdges {
public:
  /** \brief Adds the wanted kinds to an image of kinds.
   *
   * \param inverse_depth 1 / z [1/m], 0 where not measured, finite
   * \param intrinsics the camera; creases need valid ones, steps none
   * \param kinds EDGE_OCCLUSION, EDGE_CREASE or both
   * \param labels image of EdgeKind flags, the frame's size; kinds are or-ed into it
   * \throws std::invalid_argument on a parameter outside its range or a wrong size
   */
  void detect(const cv::Mat1f& inverse_depth,
              const Intrinsics& intrinsics,
              const DepthEdgeParameters& parameters,
              int kinds,
              cv::Mat1b& labels);

  /** \brief Where the last detect() saw depth steps: 1 near side, 2 far side, 3 both.
   */
  const cv::Mat1b&
  getSteps() const
  {
    return steps_;
  }

  enum StepSide : unsigned char { step_near = 1, step_far = 2 };

private:
  void findSteps(const cv::Mat1f& w, const DepthEdgeParameters& parameters);

  cv::Mat1b steps_;
  std::vector<unsigned char> candidates_;
  std::vector<int> last_;
  CreaseFinder creases_;
};

} // namespace hoist
