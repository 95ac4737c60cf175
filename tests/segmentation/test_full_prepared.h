#pragma once

// A frame taken as far as the outlines of its faces, and a scene to look at.

#include "test_full_frames.h"

#include <hoist/segmentation/cuboid_refinement.h>
#include <hoist/segmentation/cuboid_verification.h>
#include <hoist/segmentation/face_borders.h>

#include <map>
#include <utility>

namespace hoist {
namespace test {

/** \brief A true box as the full mode would put it. */
inline CuboidHypothesis
hypothesis(const samples::Box& box)
{
  CuboidHypothesis h;
  h.axes = box.axes;
  const Eigen::Vector3d middle = box.axes.transpose() * box.center;
  h.lower = middle - box.size / 2;
  h.upper = middle + box.size / 2;
  h.ends.fill(EndSource::seen);
  return h;
}

/** \brief Faces and outlines of a frame, as the full mode makes them. */
struct Prepared {
  ExactFrame frame;
  cv::Mat1s labels;
  std::vector<PlanarFace> faces;
  FaceBorders borders;
  SensorModel sensor; // scaled to the frame's noise

  explicit Prepared(const samples::Scene& scene,
                    double noise = 0,
                    std::uint64_t seed = 0)
  : frame(exactFrame(scene, noise, seed))
  {
    PlanarFaceFinder finder;
    finder.find(
        frame.images.inverse_depth, {}, frame.images.intrinsics, {}, labels, faces);
    sensor.scale = finder.noiseScale();
    findFaceBorders(labels,
                    frame.images.inverse_depth,
                    {},
                    frame.images.intrinsics,
                    sensor,
                    faces,
                    borders);
  }

  // True object and face that most pixels of a found face show.
  std::pair<int, int>
  shows(int face) const
  {
    std::map<std::pair<int, int>, int> votes;
    for (int v = 0; v < labels.rows; ++v)
      for (int u = 0; u < labels.cols; ++u)
        if (labels(v, u) == face + 1)
          ++votes[{frame.object(v, u), frame.face(v, u)}];
    return std::max_element(
               votes.begin(),
               votes.end(),
               [](const auto& a, const auto& b) { return a.second < b.second; })
        ->first;
  }

  CuboidEvidence
  verify(const CuboidHypothesis& h, const SensorModel& model) const
  {
    CuboidEvidence evidence;
    verifyCuboid(h,
                 frame.images.inverse_depth,
                 frame.images.bgr,
                 labels,
                 faces,
                 frame.images.intrinsics,
                 model,
                 3000,
                 evidence);
    return evidence;
  }

  bool
  refine(CuboidHypothesis& h, const SensorModel& model, CuboidCovariance& c) const
  {
    return refineCuboid(h,
                        verify(h, model),
                        frame.images.inverse_depth,
                        labels,
                        faces,
                        borders,
                        frame.images.intrinsics,
                        model,
                        c);
  }
};

/** \brief A carton on the ground, a wall behind it, all in view. */
inline samples::Scene
cartonBeforeWall()
{
  const samples::View view = samples::View::lookAt({0, -1.1, 0.75}, {0, 0, 0.1});
  samples::Scene scene;
  scene.boxes.push_back(view.box({0, 0, 0}, {0.8, 0.6}, {0.3, 0.22, 0.2}, {}, {}));
  scene.patches.push_back(view.ground({3, 3}, {}, {}));
  samples::Patch wall;
  wall.center = view.sensor_to_world.inverse() * Eigen::Vector3d(0, 1.2, 0);
  const Eigen::Matrix3d turn = view.sensor_to_world.linear().transpose();
  wall.axes << turn.col(0), turn.col(2), -turn.col(1);
  scene.patches.push_back(wall);
  scene.has_support = true;
  return scene;
}

/** \brief The same with a second box that covers a part of its front. */
inline samples::Scene
coveredCarton()
{
  samples::Scene scene = cartonBeforeWall();
  const samples::View view = samples::View::lookAt({0, -1.1, 0.75}, {0, 0, 0.1});
  scene.boxes.push_back(
      view.box({0.1, -0.25, 0}, {0.8, 0.6}, {0.1, 0.08, 0.24}, {}, {}));
  return scene;
}

} // namespace test
} // namespace hoist
