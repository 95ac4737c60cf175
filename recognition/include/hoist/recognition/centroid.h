#pragma once

#include <hoist/recognition/export.h>

#include <Eigen/Core>

#include <array>

namespace hoist {

/** \brief Centre of a cuboid from three edges that meet in one vertex (model I).
 *
 * The paper's triangular rule (4.3): adding the three edge vectors to the vertex, one
 * after the other, ends in the opposite vertex; the centre is half way. The edges need
 * not be exactly perpendicular.
 *
 * \param vertex where the edges meet [m]
 * \param ends the other end of each edge [m]
 */
HOIST_RECOGNITION_EXPORT Eigen::Vector3d
centroidFromVertex(const Eigen::Vector3d& vertex,
                   const std::array<Eigen::Vector3d, 3>& ends);

/** \brief Centre of a cuboid from three edges that meet in two vertices (model II).
 *
 * A middle edge joins the two vertices and each of them has one more edge. The path
 * from \a first_end over the first vertex and the second vertex to \a second_end runs
 * once along all three directions, so it joins opposite vertices; the centre is half
 * way, wherever the middle edge lies.
 *
 * \param first_end far end of the edge at the first vertex [m]
 * \param second_end far end of the edge at the second vertex [m]
 */
HOIST_RECOGNITION_EXPORT Eigen::Vector3d
centroidFromVertices(const Eigen::Vector3d& first_end,
                     const Eigen::Vector3d& second_end);

} // namespace hoist
