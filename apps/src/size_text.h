#pragma once

#include <hoist/data/cuboid.h>

#include <string>

namespace hoist {

/** \brief The side along axis \a i in centimetres: "12.3"; ">12.3" where it is a lower
 *  bound, "~12.3" where one end is hidden and known to an interval, "?" where nothing
 *  is known. */
std::string sizeText(const Cuboid& cuboid, int i);

} // namespace hoist
