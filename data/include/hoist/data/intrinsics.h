#pragma once

#include <hoist/data/export.h>

#include <Eigen/Core>

#include <cstddef>

namespace hoist {

/** \brief A pinhole camera: u = fx x / z + cx, v = fy y / z + cy.
 *
 * Frame: camera, x right, y down, z forward, metres. Units: pixels; the centre of the
 * top left pixel is (0, 0). Class invariant: none; \ref valid tells whether the numbers
 * describe a camera.
 */
struct Intrinsics {
  double fx = 0; ///< focal length along u [px], > 0
  double fy = 0; ///< focal length along v [px], > 0
  double cx = 0; ///< principal point, column [px]
  double cy = 0; ///< principal point, row [px]

  double rms = 0;          ///< root mean square residual of the inliers [px]
  std::size_t inliers = 0; ///< records that agree with the camera
  std::size_t records = 0; ///< records that were given

  bool
  valid() const
  {
    return fx > 0 && fy > 0;
  }

  /** \brief Pixel (u, v) of a point in the camera frame, z != 0. */
  Eigen::Vector2d
  project(const Eigen::Vector3d& p) const
  {
    return {fx * p.x() / p.z() + cx, fy * p.y() / p.z() + cy};
  }

  /** \brief The ray of a pixel, scaled to z = 1. */
  Eigen::Vector3d
  ray(double u, double v) const
  {
    return {(u - cx) / fx, (v - cy) / fy, 1.0};
  }
};

} // namespace hoist
