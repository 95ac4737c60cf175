#pragma once

#include <hoist/data/frame_images.h>
#include <hoist/segmentation/cuboid_selection.h>
#include <hoist/segmentation/full_mode.h>

#include <vector>

namespace hoist {
namespace detail {

/** \brief Looks at every hypothesis of a frame: briefly at all, then closely at those
 *  that may win, which are refined. Refers to its arguments. */
class CuboidJudge {
public:
  /** \param sensor with the scale of this frame's noise */
  CuboidJudge(const FrameImages& images,
              const cv::Mat1s& labels,
              const std::vector<PlanarFace>& faces,
              const FaceBorders& borders,
              const SensorModel& sensor,
              const FullModeParameters& parameters)
  : images_(images)
  , labels_(labels)
  , faces_(faces)
  , borders_(borders)
  , sensor_(sensor)
  , parameters_(parameters)
  {
  }

  /** \brief Fills evidence, and where it falls `rejected`, of the candidates, whose
   *  hypotheses are refined. */
  void judge(std::vector<CuboidCandidate>& candidates);

  /** \brief Once more with every pixel; the support is complete then. */
  void judgeFully(CuboidCandidate& candidate) const;

private:
  void verify(CuboidCandidate& candidate, int max_samples) const;
  double reach(const CuboidHypothesis& hypothesis, double steps) const;
  void glance(CuboidCandidate& candidate) const;
  bool refine(CuboidCandidate& candidate) const;
  void judgeClosely(CuboidCandidate& candidate) const;

  const FrameImages& images_;
  const cv::Mat1s& labels_;
  const std::vector<PlanarFace>& faces_;
  const FaceBorders& borders_;
  const SensorModel& sensor_;
  const FullModeParameters& parameters_;
  std::vector<CuboidHypothesis> starts_; // before refinement
  std::vector<int> order_, done_;
};

} // namespace detail
} // namespace hoist
