#pragma once

#include <hoist/data/annotation.h>
#include <hoist/simulation/render.h>
#include <hoist/simulation/scene.h>

#include <opencv2/core.hpp>

namespace hoist {
namespace simulation {

/** \brief A frame as a sensor gives it, and what is true of it. */
struct Frame {
  cv::Mat3b color;       ///< BGR, on the pixels of the depth image
  cv::Mat1f depth;       ///< z [m]; NaN where nothing was measured
  cv::Mat1w instances;   ///< label of the annotated thing of each pixel, 0 for none
  Layer exact;           ///< without any error
  FrameAnnotation truth; ///< without the names of files
  Intrinsics camera;     ///< that the points follow
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); ///< sensor to world
};

/** \brief Takes a frame. The same scene gives the same frame, wherever it is made.
 *  \throws std::runtime_error if Embree fails */
Frame simulate(const Scene& scene);

/** \brief The truth about what \a layer shows: every annotated thing of which a pixel
 * is seen. Difficult are those that are mostly hidden, cut by the border or tiny, and
 * what only carries others. */
FrameAnnotation
annotate(const Scene& scene, const RayCaster& caster, const Layer& layer);

} // namespace simulation
} // namespace hoist
