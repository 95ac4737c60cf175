#pragma once

// Frames for the tests of the full mode: exact depth without colour, rendered scenes,
// and the matching of found boxes to true ones.

#include "scene_frames.h"

#include <hoist/data/frame_images.h>
#include <hoist/segmentation/full_mode.h>
#include <hoist/segmentation/planar_faces.h>

#include <samples/random.h>
#include <samples/raycast.h>
#include <support/cuboid_compare.h>
#include <support/truth.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace hoist {
namespace test {

constexpr double degree = 3.14159265358979323846 / 180;

/** \brief What the camera sees, pixel by pixel. */
struct ExactFrame {
  FrameImages images; ///< without colour
  cv::Mat1i object;   ///< see samples::Hit; -1 for nothing
  cv::Mat1i face;     ///< see samples::Hit; -1 for nothing
};

/** \brief Depth of a scene, rounded once to float as in a cloud.
 *  \param sigma standard deviation of independent noise of the depth, as a factor on
 *         the Kinect's; 0 for none */
inline ExactFrame
exactFrame(const samples::Scene& scene, double sigma = 0, std::uint64_t seed = 0)
{
  ExactFrame frame;
  frame.images.intrinsics = scene.camera;
  frame.images.points.create(scene.height, scene.width);
  frame.images.inverse_depth.create(scene.height, scene.width);
  frame.object.create(scene.height, scene.width);
  frame.face.create(scene.height, scene.width);
  const SensorModel sensor;
  for (int v = 0; v < scene.height; ++v)
    for (int u = 0; u < scene.width; ++u) {
      const Eigen::Vector3d ray = scene.camera.ray(u, v);
      const samples::Hit hit = samples::cast(scene, Eigen::Vector3d::Zero(), ray);
      const bool any = hit.object >= 0;
      frame.object(v, u) = hit.object;
      frame.face(v, u) = any ? hit.face : -1;
      double z = hit.distance; // rays have z = 1
      if (any && sigma > 0)
        z += sigma * sensor.sigmaZ(z) * samples::hashNormal(seed, u, v);
      const Eigen::Vector3f p =
          any ? Eigen::Vector3f((z * ray).cast<float>())
              : Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
      frame.images.points(v, u) = {p.x(), p.y(), p.z()};
      frame.images.inverse_depth(v, u) = any ? 1 / p.z() : 0.0F;
    }
  return frame;
}

/** \brief The scene as the program sees it: rendered with its noise, converted. */
inline samples::FrameTruth
renderedFrame(samples::Scene scene, FrameImages& images)
{
  scene.supersampling = 1; // the full mode does not look at colour
  scene.shadows = false;
  const samples::Frame frame = samples::render(scene);
  toFrameImages(frame.cloud, images);
  return frame.truth;
}

inline std::vector<Cuboid>
segment(const FrameImages& images,
        const FullModeParameters& parameters = {},
        const cv::Mat1b& mask = {})
{
  FullMode mode;
  std::vector<Cuboid> cuboids;
  Diagnostics diagnostics;
  mode.segment(images, mask, parameters, cuboids, diagnostics);
  return cuboids;
}

/** \brief A plane normal . x = offset, as a face with nothing but its plane. */
inline PlanarFace
trueFace(const Eigen::Vector3d& normal,
         const Eigen::Vector3d& point,
         const Intrinsics& camera)
{
  PlanarFace face;
  const double d = normal.dot(point);
  const Eigen::Vector3d g = normal / d; // g . x = 1
  face.inverse_depth = {g.x() / camera.fx,
                        g.y() / camera.fy,
                        g.z() - g.x() * camera.cx / camera.fx -
                            g.y() * camera.cy / camera.fy};
  face.normal = d > 0 ? Eigen::Vector3d(-normal) : normal;
  face.offset = std::abs(d);
  face.centroid = point;
  return face;
}

/** \brief Hits, misses and false alarms by the rules of the mOSD evaluation. */
struct Matches {
  int hits = 0, misses = 0, wrong = 0;

  double
  precision() const
  {
    return hits / std::max(1.0, static_cast<double>(hits + wrong));
  }
  double
  recall() const
  {
    return hits / std::max(1.0, static_cast<double>(hits + misses));
  }
  double
  f1() const
  {
    return 2.0 * hits / std::max(1.0, 2.0 * hits + wrong + misses);
  }
};

/** \brief Adds a frame. Best score first, each found box takes the unmatched true one
 *  with the largest IoU, if that is 0.5 at least. One that belongs to a difficult box
 *  (IoU 0.25, or half of it inside) counts as nothing; difficult boxes are no misses.
 */
inline void
addMatches(const std::vector<Cuboid>& found,
           const std::vector<TruthCuboid>& truth,
           Matches& matches)
{
  std::vector<Cuboid> order = found;
  std::stable_sort(order.begin(), order.end(), [](const Cuboid& a, const Cuboid& b) {
    return a.score > b.score;
  });
  std::vector<char> used(truth.size(), 0);
  for (const Cuboid& cuboid : order) {
    int best = -1;
    double best_iou = 0.5;
    bool ignored = false;
    for (std::size_t k = 0; k < truth.size(); ++k) {
      const double overlap = iou(cuboid, truth[k].cuboid);
      if (truth[k].difficult)
        ignored |= overlap >= 0.25 ||
                   intersectionVolume(cuboid, truth[k].cuboid) >= 0.5 * cuboid.volume();
      else if (used[k] == 0 && overlap >= best_iou) {
        best_iou = overlap;
        best = static_cast<int>(k);
      }
    }
    if (best >= 0) {
      used[best] = 1;
      ++matches.hits;
    }
    else if (!ignored)
      ++matches.wrong;
  }
  for (std::size_t k = 0; k < truth.size(); ++k)
    matches.misses += !truth[k].difficult && used[k] == 0 ? 1 : 0;
}

} // namespace test
} // namespace hoist
