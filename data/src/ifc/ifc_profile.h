#pragma once

#include <hoist/data/ifc/part21.h>

#include "ifc_access.h"

#include <Eigen/Core>

#include <cstddef>
#include <stdexcept>
#include <vector>

namespace hoist {
namespace ifc {

using Points = std::vector<Eigen::Vector3d>;

/** \brief Geometry that is not simple: what it is. */
struct NotSimple : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/** \brief A length above 0.
 *  \throws LoadError */
double positive(const Entity& entity, std::size_t i);

/** \brief The points of an IfcCartesianPointList2D or 3D.
 *  \throws LoadError */
Points pointList(const Entity& entity);

/** \brief Points whose hull is that of an IfcProfileDef, or the rectangle around it, in
 *  its plane.
 *  \throws LoadError, NotSimple for profiles that are not read */
Points profilePoints(const Part21File& file, const Entity& entity);

} // namespace ifc
} // namespace hoist
