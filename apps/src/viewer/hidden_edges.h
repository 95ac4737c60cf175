#pragma once

#include <Eigen/Core>

namespace hoist {

/** \brief Which of a box's edges it hides itself, a bit for each of Cuboid::edges().
 *  None where the eye is inside.
 *  \param eye where the camera is; with \a parallel the unit vector towards it */
int hiddenEdges(const Eigen::Matrix<double, 3, 8>& corners,
                const Eigen::Vector3d& eye,
                bool parallel);

} // namespace hoist
