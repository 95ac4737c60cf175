#pragma once

#include <hoist/data/frame_images.h>
#include <hoist/data/result.h>
#include <hoist/data/sensor_model.h>
#include <hoist/segmentation/export.h>
#include <hoist/segmentation/line_lift.h>
#include <hoist/segmentation/line_segments.h>

#include <vector>

namespace hoist {

/** \brief The numbers of LineSegmentExtraction; its setters describe them. */
struct LineExtractionParameters {
  LineLift lift = LineLift::robust;
  HoughParameters hough;
  SensorModel sensor;
  int end_search_radius = 0; ///< [px], >= 0
  int strip_width = 4;       ///< [px], >= 2
  double min_length = 0;     ///< [m], >= 0
};

/** \brief The line segments of an edge mask: the core of LineSegmentExtraction, without
 * a cloud.
 *
 * \param mask height x width of the frame, non-zero on edge pixels
 * \param segments cleared, then filled
 * \param diagnostics "image segments", "line segments" and reject reasons are added
 * \throw std::invalid_argument if the mask has another size or a Hough number is out of
 *        range
 */
HOIST_SEGMENTATION_EXPORT void
extractLineSegments(const FrameImages& images,
                    const cv::Mat1b& mask,
                    const LineExtractionParameters& parameters,
                    std::vector<LineSegment>& segments,
                    Diagnostics& diagnostics);

} // namespace hoist
