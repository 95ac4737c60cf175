#pragma once

#include <hoist/data/cuboid.h>
#include <hoist/recognition/export.h>

#include <string>
#include <vector>

namespace hoist {

/** \brief What a cuboid is made of. */
struct Material {
  const char* name;    ///< lower case, as on the command line
  double density;      ///< [kg/m3]
  double density_low;  ///< [kg/m3], lower end of the range met in practice
  double density_high; ///< [kg/m3], upper end
  const char* source;  ///< where the numbers come from
};

/** \brief The table of materials. Solid bodies: a hollow part weighs less. */
HOIST_RECOGNITION_EXPORT const std::vector<Material>& materials();

/** \brief The material of that name, or nullptr. */
HOIST_RECOGNITION_EXPORT const Material* findMaterial(const std::string& name);

/** \brief A weight and how sure it is. */
struct Weight {
  double value = 0; ///< [kg]
  double sigma = 0; ///< standard deviation [kg]; NaN where the sizes have none
};

/** \brief Volume times density, the paper's invisible attribute (4.3, conclusion 2).
 *
 * sigma: first order propagation of the three sizes' sigmas and of a density spread
 * evenly over its range, taken as independent:
 * (sigma / w)^2 = sum_i (sigma_i / size_i)^2 + ((high - low) / sqrt(12) / density)^2.
 */
HOIST_RECOGNITION_EXPORT Weight estimateWeight(const Cuboid& cuboid,
                                               const Material& material);

} // namespace hoist
