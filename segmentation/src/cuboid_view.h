#pragma once

#include <hoist/segmentation/cuboid_verification.h>

#include <algorithm>
#include <array>

namespace hoist {
namespace detail {

/** \brief A plane as a linear function of the pixel: inverse depth a u + b v + c. */
struct PixelPlane {
  double a = 0, b = 0, c = 0;

  double
  at(double u, double v) const
  {
    return a * u + b * v + c;
  }
};

/** \brief The plane n . x = d, d != 0, in inverse depth. */
PixelPlane toPixels(const Eigen::Vector3d& n, double d, const Intrinsics& camera);

/** \brief A box as the camera sees it: which faces are seen and where in the image. */
struct CuboidView {
  const CuboidHypothesis& box;
  const Intrinsics& camera;
  const SensorModel& sensor;

  std::array<int, 3> front{}; ///< visible faces
  int fronts = 0;
  std::array<int, 6> hidden{}; ///< the others
  int n_hidden = 0;
  std::array<PixelPlane, 6> planes; ///< of all faces; the hidden ones moved inwards
  int left = 0, right = -1, top = 0, bottom = -1; ///< rectangle in the image [px]
  double pixel = 0;                               ///< size of a pixel at the centre [m]

  CuboidView(const CuboidHypothesis& hypothesis,
             const Intrinsics& intrinsics,
             const SensorModel& sensor_model,
             const cv::Size& image);

  /// False if the box reaches behind the camera, contains it, or lies off the image.
  bool
  valid() const
  {
    return fronts > 0 && left <= right && top <= bottom;
  }

  /// Whether the box is seen at a pixel, the rim of its outline excepted.
  bool
  covers(double u, double v) const
  {
    double enter = planes[front[0]].at(u, v);
    for (int i = 1; i < fronts; ++i)
      enter = std::min(enter, planes[front[i]].at(u, v));
    bool inside = enter > 0;
    for (int i = 0; i < n_hidden && inside; ++i)
      inside = planes[hidden[i]].at(u, v) < enter;
    return inside;
  }
};

constexpr double min_depth = 0.05; // nearer is no measurement [m]

/** \brief Fills faces, support and stride of the evidence. */
void collectFaceEvidence(const CuboidView& view,
                         const cv::Mat1f& inverse_depth,
                         int max_samples,
                         CuboidEvidence& evidence);

/** \brief Fills edges of the evidence. */
void collectOutlineEvidence(const CuboidView& view,
                            const cv::Mat1f& inverse_depth,
                            const cv::Mat3b& colors,
                            const cv::Mat1s& labels,
                            const std::vector<PlanarFace>& faces,
                            int max_samples,
                            CuboidEvidence& evidence);

} // namespace detail
} // namespace hoist
