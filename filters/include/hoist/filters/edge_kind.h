#pragma once

#include <cstdint>

namespace hoist {

/** \brief What makes a pixel an edge pixel; bit flags, one pixel can be several.
 *
 * Images of kinds are cv::Mat1b, 0 where there is no edge.
 */
enum EdgeKind : std::uint8_t {
  EDGE_NONE = 0,
  EDGE_COLOR = 1,     ///< a contour of the grey image (improved Canny)
  EDGE_OCCLUSION = 2, ///< the near side of a depth step, or where a surface ends
  EDGE_CREASE = 4,    ///< two surfaces meet
  EDGE_ALL = 7
};

} // namespace hoist
