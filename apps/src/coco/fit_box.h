#pragma once

#include <hoist/data/intrinsics.h>
#include <hoist/data/oriented_box.h>

#include <opencv2/core.hpp>

#include <optional>
#include <vector>

namespace hoist {

/** \brief The points that a mask shows.
 *  \param depth z along the optical axis [m], NaN for none, of the mask's size
 *  \return camera frame [m]; where depth jumps between neighbours, and of what lies far
 *          behind or before the rest (the outline's rim), none */
std::vector<Eigen::Vector3d>
pointsOf(const cv::Mat1b& mask, const cv::Mat1f& depth, const Intrinsics& camera);

/** \brief The upright box around points, but for one in a hundred on each side.
 *
 * Its last axis is \a up. Seen from above, the other two are those of the rectangle to
 * whose sides the points are nearest on average, searched to a tenth of a degree. What
 * is not seen of a thing is not in its box.
 * \param points camera frame [m]
 * \param up in the camera frame, of any length but 0
 * \return nothing of fewer than 20 points or of a box without extent */
std::optional<OrientedBox> uprightBox(const std::vector<Eigen::Vector3d>& points,
                                      const Eigen::Vector3d& up);

} // namespace hoist
