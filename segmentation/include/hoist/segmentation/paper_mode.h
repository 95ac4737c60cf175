#pragma once

#include <hoist/data/cuboid.h>
#include <hoist/data/frame_images.h>
#include <hoist/data/result.h>
#include <hoist/filters/canny.h>
#include <hoist/segmentation/endpoint_clustering.h>
#include <hoist/segmentation/export.h>
#include <hoist/segmentation/line_segment.h>
#include <hoist/segmentation/line_segments.h>
#include <hoist/segmentation/vertex_models.h>

#include <opencv2/core.hpp>

#include <vector>

namespace hoist {

/** \brief The numbers of the paper's method. */
struct PaperModeParameters {
  CannyParameters canny; ///< 4.2.1; threshold_scale is set by the schedule

  /// The circular process: round i works with both Canny thresholds times
  /// first_scale * scale_factor^i. From few strong contours to many weak ones.
  double first_scale = 2.0;  ///< > 0
  double scale_factor = 0.8; ///< in (0, 1)
  int max_rounds = 10;       ///< >= 1
  /// Figure 4 ends with the first round that satisfies a model; false goes through the
  /// whole schedule and keeps the best cuboid of each box.
  bool stop_when_satisfied = true;

  HoughParameters hough;            ///< 4.2.2
  int end_search_radius = 0;        ///< for an end pixel without a point [px], >= 0
  double min_length = 0;            ///< shortest segment [m], >= 0
  double distance_threshold = 0.03; ///< D of 4.2.3 [m], >= 0
  double tolerance = 0.05;          ///< equation 3, >= 0; a cosine if normalized
  bool normalized = true;           ///< unit vectors in equation 3, or raw [m^2]
  int max_degree = 64;              ///< segments of a vertex that is searched, >= 3

  /** \brief Every number in its range (Canny's are checked by Canny). */
  HOIST_SEGMENTATION_EXPORT bool valid() const;
};

/** \brief All that the paper's method made of a frame. */
struct PaperModeResult {
  std::vector<Cuboid> cuboids;       ///< best score first
  std::vector<LineSegment> segments; ///< what Cuboid::segments counts
  std::vector<Vertex> vertices;      ///< what Cuboid::vertices counts
  cv::Mat1b edges;                   ///< height x width, 255 on edge pixels

  /** \brief Empties it; the image keeps its memory. */
  void
  clear()
  {
    cuboids.clear();
    segments.clear();
    vertices.clear();
    edges.setTo(0);
  }
};

/** \brief The circular image processing of the paper's Figure 4.
 *
 * Canny (4.2.1), Hough (4.2.2), lift of the end pixels (Table 2), clustering of the
 * ends (4.2.3), vertex models I and II (4.2.4), and again with an adjusted threshold
 * until a model is satisfied or the schedule ends. Segments are not joined, lines are
 * not fitted, cuboids are not verified: the paper has none of that. Of the cuboids that
 * several triples give for one box the best is kept (keepBestOfEachBox).
 *
 * Holds the buffers that are reused from frame to frame; not thread safe, use one per
 * thread.
 */
class HOIST_SEGMENTATION_EXPORT PaperMode {
public:
  /** \param images the frame; must have colour
   *  \param mask pixels to use (non-zero), height x width, or empty for all. Canny sees
   *         their bounding rectangle, a detector's fragment; edges outside the mask are
   *         dropped
   *  \param result cleared, then filled. Segments and vertices are those of the round
   *         that satisfied a model, or of the last one; of all rounds if it does not
   *         stop when satisfied
   *  \param diagnostics counts and reject reasons of those rounds are added, and
   *         "rounds"
   *  \return false if the frame has no colour; the result is then empty
   *  \throw std::invalid_argument if a parameter is out of range */
  bool segment(const FrameImages& images,
               const cv::Mat1b& mask,
               const PaperModeParameters& parameters,
               PaperModeResult& result,
               Diagnostics& diagnostics);

private:
  void runRound(const FrameImages& images,
                const PaperModeParameters& parameters,
                PaperModeResult& result,
                Diagnostics& diagnostics);

  Canny canny_;
  EndpointClustering clustering_;
  VertexModels models_;
  cv::Mat1b fragment_edges_;
  PaperModeResult round_;
};

} // namespace hoist
