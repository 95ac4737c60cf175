#pragma once

#include <hoist/data/ifc/ifc_model.h>

#include "ifc_access.h"

#include <optional>
#include <string_view>

namespace hoist {
namespace ifc {

/** \brief What is measured in a project. */
struct Units {
  double length = 1; ///< metres per unit
  double mass = 1;   ///< kg per unit
};

/** \brief The units of a project; metres and kg where it names none.
 *  \throws LoadError for units that are neither SI nor converted to it */
Units unitsOf(const Part21File& file, const Entity& project);

/** \brief Factor to metres or kg of a measure, 1 for what is neither. */
double factorOf(std::string_view measure, const Units& units);

/** \brief The factor of a named unit to the SI (kg for masses).
 *  \throws LoadError */
double unitFactor(const Part21File& file, const Entity& unit, int depth = 0);

/** \brief A property set or set of quantities; nothing if the instance is neither. */
std::optional<IfcPropertySet>
readPropertySet(const Part21File& file, std::uint64_t id, const Units& units);

} // namespace ifc
} // namespace hoist
