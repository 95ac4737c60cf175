#include <hoist/segmentation/extract_line_segments.h>

#include <stdexcept>

namespace hoist {

void
extractLineSegments(const FrameImages& images,
                    const cv::Mat1b& mask,
                    const LineExtractionParameters& parameters,
                    std::vector<LineSegment>& segments,
                    Diagnostics& diagnostics)
{
  constexpr int support_radius = 1; // [px]; an edge is two pixels wide at most
  segments.clear();
  if (mask.size() != images.points.size())
    throw std::invalid_argument(
        "hoist::extractLineSegments: mask and frame differ in size");
  std::vector<PixelSegment> found;
  houghSegments(mask, parameters.hough, found);
  diagnostics.counts.add("image segments", found.size());
  const bool robust = parameters.lift == LineLift::robust;
  if (robust)
    mergeSegments(found, {0.05, 2.0, parameters.hough.max_gap});

  segments.reserve(found.size());
  for (PixelSegment& segment : found) {
    LineSegment line;
    collectSupport(mask, segment, support_radius, line.indices);
    if (robust)
      refineSegment(line.indices, mask.cols, segment);
    const LiftStatus status =
        robust ? liftRobust(
                     images, segment, parameters.sensor, parameters.strip_width, line)
               : liftEndpoints(images, segment, parameters.end_search_radius, line);
    if (status != LiftStatus::lifted)
      diagnostics.rejected.add(toString(status));
    else if (line.length() < parameters.min_length)
      diagnostics.rejected.add("segment too short");
    else
      segments.push_back(std::move(line));
  }
  diagnostics.counts.add("line segments", segments.size());
}

} // namespace hoist
