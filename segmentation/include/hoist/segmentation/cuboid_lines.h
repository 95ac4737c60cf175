#pragma once

#include <hoist/data/cuboid.h>
#include <hoist/data/frame_images.h>
#include <hoist/data/result.h>
#include <hoist/data/sensor_model.h>
#include <hoist/filters/edge_detector.h>
#include <hoist/segmentation/endpoint_clustering.h>
#include <hoist/segmentation/export.h>
#include <hoist/segmentation/line_segment.h>

#include <opencv2/core.hpp>

#include <vector>

namespace hoist {

/** \brief Names the segments and vertices that lie on each cuboid.
 *
 * A segment supports a cuboid if both its ends lie within \a distance of the same edge
 * of it, a vertex if it lies within \a distance of a corner.
 *
 * \param distance [m], >= 0
 * \param cuboids their segments and vertices are replaced, ascending
 */
HOIST_SEGMENTATION_EXPORT void attachLines(const std::vector<LineSegment>& segments,
                                           const std::vector<Vertex>& vertices,
                                           double distance,
                                           std::vector<Cuboid>& cuboids);

/** \brief Edge pixels, line segments and vertices of a frame: the evidence by lines
 * that the full mode shows beside its cuboids.
 *
 * All kinds of edges, robustly lifted segments, ends clustered with D = 0.03 m. Holds
 * buffers that are reused; not thread safe.
 */
class HOIST_SEGMENTATION_EXPORT CuboidLines {
public:
  /** \param mask pixels to use (non-zero), height x width, or empty for all
   *  \param edges 255 on edge pixels, else 0
   *  \param segments, vertices cleared, then filled
   *  \param diagnostics "edge pixels", "image segments", "line segments", "vertices"
   *         and reasons are added */
  void find(const FrameImages& images,
            const cv::Mat1b& mask,
            const SensorModel& sensor,
            cv::Mat1b& edges,
            std::vector<LineSegment>& segments,
            std::vector<Vertex>& vertices,
            Diagnostics& diagnostics);

private:
  EdgeDetector detector_;
  EndpointClustering clustering_;
  cv::Mat1b labels_;
};

} // namespace hoist
