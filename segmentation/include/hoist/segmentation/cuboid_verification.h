#pragma once

#include <hoist/data/frame_images.h>
#include <hoist/data/sensor_model.h>
#include <hoist/segmentation/cuboid_hypotheses.h>
#include <hoist/segmentation/export.h>

#include <opencv2/core.hpp>

#include <array>
#include <vector>

namespace hoist {

/** \brief What the frame says of one visible face of a cuboid, in sampled pixels. */
struct FaceEvidence {
  int support = 0;             ///< measured where the face should be
  int occluded = 0;            ///< something nearer is in front
  int contradiction = 0;       ///< the sensor saw through it
  int missing = 0;             ///< nothing measured
  double missing_weight = 0.5; ///< how much a missing pixel counts against it
  double flat = 0; ///< share of what is not covered where the mean depth is right
};

/** \brief What the frame says of an edge between a visible and a hidden face. */
struct EdgeEvidence {
  int face = 0;      ///< the visible one
  int neighbour = 0; ///< the hidden one
  int samples = 0;   ///< along the edge
  int good = 0;      ///< the surface ends in a step
  int bad = 0;       ///< it goes on beyond the box or bends away slowly
  int color = 0;     ///< it goes on in another colour: says nothing
};

/** \brief What the frame says of a cuboid. */
struct CuboidEvidence {
  std::array<FaceEvidence, 6> faces; ///< lower 0, upper 0, lower 1, ...
  std::array<bool, 6> visible{};     ///< faces that look at the camera
  std::vector<EdgeEvidence> edges;   ///< the outline
  double flat = 0;          ///< share of the uncovered area that lies on the faces
  double outline = 0;       ///< share of the outline where the surface ends
  double score = 0;         ///< in [0, 1]
  double trust = 0;         ///< how well the ends are known, in [0, 1]
  int stride = 1;           ///< one pixel in stride x stride was looked at; 0: none yet
  std::vector<int> support; ///< supporting pixels, indices into the frame

  /// Nothing said; the vectors keep their memory.
  void
  clear()
  {
    faces = {};
    visible = {};
    edges.clear();
    support.clear();
    flat = outline = score = trust = 0;
    stride = 1;
  }

  /// Supporting pixels, whether looked at or not.
  double
  pixels() const
  {
    return static_cast<double>(supported()) * stride * stride;
  }

  /// What a choice among boxes weighs: the pixels it explains by the chance of being
  /// right; where two explain the same, the one that invents less.
  double
  value() const
  {
    return score * mostValue();
  }

  /// The value if all that was looked at spoke for it.
  double
  mostValue() const
  {
    const double known = trust * trust;
    return known * known * pixels();
  }

  int
  supported() const
  {
    int n = 0;
    for (const auto& f : faces)
      n += f.support;
    return n;
  }
};

/** \brief How well the ends of a box are known, in [0, 1]: the product of 1 for each
 *  seen, 0.95 for each supported, bracketed or catalogue's, 0.92 for each touched, 0.9
 * for each unknown and 0.6 for each hidden one. */
HOIST_SEGMENTATION_EXPORT double trustInEnds(const CuboidHypothesis& hypothesis);

/** \brief The score of a box of which the frame says nothing but good, in [0, 1].
 *  \param trust see trustInEnds() */
HOIST_SEGMENTATION_EXPORT double highestScore(double trust);

/** \brief Projects a cuboid into the frame and lets every pixel inside say support,
 *  occluded or contradiction.
 *
 * \param hypothesis the box, in front of the camera
 * \param colors same size as the depth, or empty
 * \param labels number of the face + 1 at each pixel, 0 where none
 * \param faces the faces that labels speaks of
 * \param max_samples the stride is chosen so that about this many pixels are looked at
 * \param evidence overwritten; its score is the share of the evidence in favour
 */
HOIST_SEGMENTATION_EXPORT void verifyCuboid(const CuboidHypothesis& hypothesis,
                                            const cv::Mat1f& inverse_depth,
                                            const cv::Mat3b& colors,
                                            const cv::Mat1s& labels,
                                            const std::vector<PlanarFace>& faces,
                                            const Intrinsics& camera,
                                            const SensorModel& sensor,
                                            int max_samples,
                                            CuboidEvidence& evidence);

} // namespace hoist
