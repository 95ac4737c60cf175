#pragma once

#include <hoist/data/sensor_model.h>

#include <Eigen/Core>

namespace hoist {
namespace detail {

/** \brief Sums over pixels (u, v) with inverse depth w, for the least squares plane
 * w = a u + b v + c. */
struct PlaneMoments {
  double n = 0, u = 0, v = 0, uu = 0, uv = 0, vv = 0, w = 0, uw = 0, vw = 0, ww = 0;

  PlaneMoments& operator+=(const PlaneMoments& o);

  /** \brief Adds pixels (first .. first + count - 1, v) of one row: sums over positions
   * are known in closed form.
   *  \param sum_w sum of w; \param sum_kw of k w, k from 0; \param sum_ww of w^2 */
  void addRun(int first, int v, int count, double sum_w, double sum_kw, double sum_ww);

  /// False where the pixels span no plane; then \a plane is not touched.
  bool fit(Eigen::Vector3d& plane) const;

  /// Mean and mean square of w - plane, n > 0.
  void residual(const Eigen::Vector3d& plane, double& mean, double& square) const;
};

/** \brief Sensor noise carried over to inverse depth, w = 1/z: sigma_w = sigma_z w^2.
 *
 * For each kind of SensorModel that is a polynomial of second degree in w: no table, no
 * division, and the compiler can take several pixels at once. */
struct InverseDepthNoise {
  double constant = 0, linear = 0, square = 0;

  InverseDepthNoise() = default;
  explicit InverseDepthNoise(const SensorModel& sensor);

  double
  operator()(double w) const
  {
    return constant + w * (linear + w * square);
  }

  InverseDepthNoise operator*(double factor) const;
};

} // namespace detail
} // namespace hoist
