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
  int support = 0;       ///< measured where the face should be
  int occluded = 0;      ///< something nearer is in front
  int contradiction = 0; ///< the sensor saw through it
  int missing = 0;       ///< nothing measured
};

/** \brief What the frame says of a cuboid. */
struct CuboidEvidence {
  std::array<FaceEvidence, 6> faces; ///< lower 0, upper 0, lower 1, ...
  std::array<bool, 6> visible{};     ///< faces that look at the camera
  int edge_good = 0;        ///< outline samples where the surface ends as it should
  int edge_bad = 0;         ///< outline samples where a face goes on beyond the box
  double score = 0;         ///< in [0, 1]
  int stride = 1;           ///< one pixel in stride x stride was looked at
  std::vector<int> support; ///< supporting pixels, indices into the frame

  int
  supported() const
  {
    int n = 0;
    for (const auto& f : faces)
      n += f.support;
    return n;
  }
};

/** \brief Projects a cuboid into the frame and lets every pixel inside say support,
 *  occluded or contradiction.
 *
 * \param hypothesis the box, in front of the camera
 * \param max_samples the stride is chosen so that about this many pixels are looked at
 * \param evidence overwritten; its score is the share of the evidence in favour
 */
HOIST_SEGMENTATION_EXPORT void verifyCuboid(const CuboidHypothesis& hypothesis,
                                            const cv::Mat1f& inverse_depth,
                                            const Intrinsics& camera,
                                            const SensorModel& sensor,
                                            int max_samples,
                                            CuboidEvidence& evidence);

} // namespace hoist
