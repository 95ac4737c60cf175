#pragma once

#include <cmath>

namespace hoist {

/** \brief Depth noise as a function of depth: the one place where a sensor is
 * described.
 *
 * Every threshold in metres follows \ref sigmaZ. Sources: Nguyen, Izadi, Lovell,
 * "Modeling Kinect Sensor Noise", 3DIMPVT 2012 (axial noise at small angles); stereo:
 * first order error propagation of z = f B / d.
 */
struct SensorModel {
  enum class Kind { kinect, stereo, constant };

  Kind kind = Kind::kinect;
  double focal_baseline = 0.0;  ///< stereo: f * B [px m], > 0
  double sigma_disparity = 0.2; ///< stereo: standard deviation of the disparity [px]
  double sigma_constant = 0.0;  ///< constant: standard deviation of z [m]
  double scale = 1.0; ///< factor on the whole, e.g. from the frame itself, > 0

  static SensorModel
  kinect()
  {
    return {};
  }

  /** \param focal_baseline focal length times baseline [px m]
   *  \param sigma_disparity standard deviation of the disparity [px] */
  static SensorModel
  stereo(double focal_baseline, double sigma_disparity = 0.2)
  {
    SensorModel model;
    model.kind = Kind::stereo;
    model.focal_baseline = focal_baseline;
    model.sigma_disparity = sigma_disparity;
    return model;
  }

  /** \param sigma standard deviation of z at any depth [m] */
  static SensorModel
  constant(double sigma)
  {
    SensorModel model;
    model.kind = Kind::constant;
    model.sigma_constant = sigma;
    return model;
  }

  /** \brief Standard deviation of a depth [m] measured at depth \a z [m], z > 0. */
  double
  sigmaZ(double z) const
  {
    switch (kind) {
    case Kind::stereo:
      return scale * z * z * sigma_disparity / focal_baseline;
    case Kind::constant:
      return scale * sigma_constant;
    case Kind::kinect:
      break;
    }
    return scale * (0.0012 + 0.0019 * (z - 0.4) * (z - 0.4));
  }
};

} // namespace hoist
