#pragma once

#include <hoist/data/ifc/part21.h>
#include <hoist/data/oriented_box.h>

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace hoist {
namespace ifc {

/** \brief A part of a shape: points that span it and the axes along which it lies. */
struct Part {
  std::vector<Eigen::Vector3d> points;
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  std::string kind;
};

/** \brief Shapes of many points by their id, once they were looked at. */
using ShapeCache = std::unordered_map<std::uint64_t, Part>;

/** \brief The box of an IfcProductDefinitionShape, in the product's frame and units of
 *  the model.
 *
 * Exact for extruded rectangles, blocks, bounding boxes and eight corners; of all else
 * the box around the points, along the axes of the largest part.
 *
 * \param source what it was made from, or why there is no box
 */
std::optional<OrientedBox> shapeBox(const Part21File& file,
                                    std::uint64_t shape,
                                    ShapeCache& cache,
                                    std::string& source);

} // namespace ifc
} // namespace hoist
