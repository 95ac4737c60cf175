#pragma once

#include <hoist/segmentation/cuboid_verification.h>
#include <hoist/segmentation/face_borders.h>

#include <Eigen/Core>

#include <opencv2/core.hpp>

#include <vector>

namespace hoist {

/** \brief What the frame knows of the nine parameters of a cuboid. */
struct CuboidCovariance {
  Eigen::Vector3d center; ///< standard deviations along the camera's axes [m]
  Eigen::Vector3d size;   ///< standard deviations of the side lengths [m]
  double rotation = 0;    ///< root of the summed variances of the three turns [rad]
};

/** \brief Fits pose and size together to the face pixels and to the outline.
 *
 * Gauss-Newton on nine parameters (three turns, six ends) with robust weights. A face
 * pixel's residual is its distance to the face's plane over the sensor's noise along
 * the normal; an outline element's is its distance to the nearest end within the face's
 * plane over the lateral noise. Elements lie on the pixel's side, half a pixel outside
 * of its centre, which removes the shrink by half a pixel at every edge.
 *
 * \param hypothesis start, overwritten with the result; a step that does not converge
 *        leaves it unchanged
 * \param evidence of the start; its supporting pixels are the face pixels
 * \return false if the fit is singular or moved away
 */
HOIST_SEGMENTATION_EXPORT bool refineCuboid(CuboidHypothesis& hypothesis,
                                            const CuboidEvidence& evidence,
                                            const cv::Mat1f& inverse_depth,
                                            const cv::Mat1s& labels,
                                            const std::vector<PlanarFace>& faces,
                                            const FaceBorders& borders,
                                            const Intrinsics& camera,
                                            const SensorModel& sensor,
                                            CuboidCovariance& covariance);

} // namespace hoist
