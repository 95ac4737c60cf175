#pragma once

#include <hoist/filters/export.h>

#include <opencv2/core.hpp>

#include <vector>

namespace hoist {

/** \brief Pixels whose centre lies in a polygon: 255, else 0.
 *
 * Even-odd rule; a centre on a left or upper side is inside, on a right or lower side
 * outside, so that polygons that share a side share no pixel. Parts outside the image
 * are cut off.
 *
 * \param polygon at least 3 corners [px], (u, v), finite; closed by itself
 * \param mask its size is the image's; overwritten
 * \throws std::invalid_argument otherwise
 */
HOIST_FILTERS_EXPORT void fillPolygon(const std::vector<cv::Point2f>& polygon,
                                      cv::Mat1b& mask);

} // namespace hoist
