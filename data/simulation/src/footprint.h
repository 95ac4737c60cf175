#pragma once

#include <Eigen/Core>

#include <cmath>

namespace hoist {
namespace simulation {

/** \brief A rectangle on the ground [m]. */
struct Footprint {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  Eigen::Vector2d axis = Eigen::Vector2d::UnitX(); ///< unit
  Eigen::Vector2d half = Eigen::Vector2d::Zero();

  Eigen::Vector2d
  side() const
  {
    return {-axis.y(), axis.x()};
  }

  /** \brief Half its extent along a unit direction. */
  double
  reach(const Eigen::Vector2d& direction) const
  {
    return half.x() * std::abs(axis.dot(direction)) +
           half.y() * std::abs(side().dot(direction));
  }
};

/** \brief Whether two are closer than \a margin (separating axes: one of the four
 * sides' directions tells, or they meet). */
inline bool
meet(const Footprint& a, const Footprint& b, double margin)
{
  const Eigen::Vector2d way = b.center - a.center;
  for (const Eigen::Vector2d& axis : {a.axis, a.side(), b.axis, b.side()})
    if (std::abs(way.dot(axis)) >= a.reach(axis) + b.reach(axis) + margin)
      return false;
  return true;
}

/** \brief Whether a lies wholly in b. */
inline bool
within(const Footprint& a, const Footprint& b)
{
  const Eigen::Vector2d way = a.center - b.center;
  return std::abs(way.dot(b.axis)) + a.reach(b.axis) <= b.half.x() &&
         std::abs(way.dot(b.side())) + a.reach(b.side()) <= b.half.y();
}

} // namespace simulation
} // namespace hoist
