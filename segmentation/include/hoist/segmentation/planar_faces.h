#pragma once

#include <hoist/data/intrinsics.h>
#include <hoist/data/sensor_model.h>
#include <hoist/segmentation/export.h>

#include <Eigen/Core>

#include <opencv2/core.hpp>

#include <memory>
#include <vector>

namespace hoist {

/** \brief A connected flat piece of the frame.
 *
 * A plane is linear in inverse depth: 1/z = a u + b v + c at pixel (u, v), and a depth
 * camera's noise is nearly constant there, so the least squares fit needs no weights.
 */
struct PlanarFace {
  Eigen::Vector3d inverse_depth; ///< (a, b, c) [1/(m px), 1/(m px), 1/m]
  Eigen::Vector3d normal;        ///< unit normal, towards the camera
  double offset = 0;             ///< normal . x + offset = 0 [m], offset > 0
  Eigen::Vector3d centroid;      ///< mean point [m]
  int pixels = 0;                ///< size of the piece
  double rms = 0;                ///< residual of the fit in units of the sensor's sigma
  double normal_sigma = 0;       ///< standard deviation of the weakest tilt [rad]
  cv::Rect box;                  ///< bounding box in the image
};

/** \brief How far a point on the face moves along unit vector \a d per pixel in the
 * image, at the face's centroid [m/px]. Large where the face is foreshortened along \a
 * d: an edge that is one pixel off is off by as much. */
HOIST_SEGMENTATION_EXPORT double
footprint(const PlanarFace& face, const Eigen::Vector3d& d, const Intrinsics& camera);

struct PlanarFaceParameters {
  SensorModel sensor;
  double mean_tolerance = 2.0;  ///< cell mean against the plane [sigma]
  double rms_tolerance = 2.5;   ///< cell rms against the plane [sigma]
  double pixel_tolerance = 3.0; ///< single pixel against the plane [sigma]
  int min_pixels = 60;          ///< smaller pieces are dropped
};

/** \brief Splits the frame into flat pieces by growing regions of 4 x 4 pixel cells,
 * then gives every pixel near a border to the plane it fits best, which puts creases
 * where the planes meet.
 *
 * Seeds are windows of 16, 8 and 4 x 16 pixels, the flattest first, so that large faces
 * are found before thin ones. Keeps its buffers from frame to frame.
 */
class HOIST_SEGMENTATION_EXPORT PlanarFaceFinder {
public:
  PlanarFaceFinder();
  ~PlanarFaceFinder();
  PlanarFaceFinder(PlanarFaceFinder&&) noexcept;
  PlanarFaceFinder& operator=(PlanarFaceFinder&&) noexcept;

  /** \param inverse_depth height x width [1/m], 0 where not measured
   *  \param camera valid intrinsics of the image
   *  \param mask pixels to use (non-zero), same size, or empty
   *  \param labels out: number of the face + 1, 0 where none; same size
   *  \param faces out: cleared first */
  void find(const cv::Mat1f& inverse_depth,
            const cv::Mat1b& mask,
            const Intrinsics& camera,
            const PlanarFaceParameters& parameters,
            cv::Mat1s& labels,
            std::vector<PlanarFace>& faces);

  /** \brief How noisy the last frame was, as a factor on the sensor model.
   *
   * From the flattest windows: the lower quartile of their rms over sigma, times two
   * for the waves that a window of 16 pixels does not show; within [0.05, 1], so that
   * the same settings serve perfect synthetic planes and a real sensor. */
  double
  noiseScale() const
  {
    return noise_scale_;
  }

private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
  double noise_scale_ = 1;
};

} // namespace hoist
