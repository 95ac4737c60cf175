#pragma once

#include <hoist/data/cuboid.h>
#include <hoist/data/frame_images.h>
#include <hoist/data/result.h>
#include <hoist/data/sensor_model.h>
#include <hoist/segmentation/export.h>

#include <opencv2/core.hpp>

#include <array>
#include <memory>
#include <vector>

namespace hoist {

/** \brief What a user may ask of the full mode. Lengths in metres. */
struct FullModeParameters {
  SensorModel sensor; ///< every distance threshold follows its sigmaZ

  double min_side = 0.015; ///< shortest side of a reported cuboid [m], > 0
  double max_side = 5.0;   ///< longest side [m], >= min_side
  double min_score = 0.5;  ///< cuboids below are not reported, in [0, 1]
  int max_cuboids = 0;     ///< keep the best n; 0 = all
};

/** \brief All cuboids of a frame from its faces, edges and vertices.
 *
 * Holds the buffers that are reused from frame to frame; not thread safe, use one per
 * thread.
 */
class HOIST_SEGMENTATION_EXPORT FullMode {
public:
  FullMode();
  ~FullMode();
  FullMode(FullMode&&) noexcept;
  FullMode& operator=(FullMode&&) noexcept;

  /** \param images the frame; intrinsics must be valid
   *  \param mask pixels to use (non-zero), height x width, or empty for all
   *  \param cuboids cleared, then filled, best score first
   *  \param diagnostics counts and reject reasons are added
   *  \return false if the frame has no valid intrinsics; outputs are then empty */
  bool segment(const FrameImages& images,
               const cv::Mat1b& mask,
               const FullModeParameters& parameters,
               std::vector<Cuboid>& cuboids,
               Diagnostics& diagnostics);

private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

} // namespace hoist
