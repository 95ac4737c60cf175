#pragma once

#include <hoist/data/frame_images.h>
#include <hoist/data/result.h>
#include <hoist/segmentation/line_segment.h>

#include <opencv2/core.hpp>

#include <vector>

namespace hoist {

/** \brief What an overlay shows. */
struct OverlayContents {
  const FrameImages& images;
  const FrameResult& result;
  cv::Mat1b edges; ///< EdgeKind flags, height x width, or empty for no edges
  std::vector<LineSegment> segments;
  std::vector<Vertex> vertices;
};

/** \brief The frame's picture with everything that was found drawn on it.
 *
 * The picture is dimmed and enlarged to at least 1280 columns. Edge pixels are coloured
 * by kind, segments are thin lines, faint where they are on no edge of a cuboid,
 * vertices are rings. Every cuboid has a colour of its own, solid edges where they are
 * seen and dashed ones behind itself or anything nearer, and a label with its sizes in
 * cm, beside it with a line that leads there (in
 * the order length, width, height; "?" where a size was not observable, ">" where it is
 * a lower bound), score and colour. Frames without colour show their depth. A footer
 * names the scene and the colours.
 */
cv::Mat3b drawOverlay(const OverlayContents& contents);

} // namespace hoist
