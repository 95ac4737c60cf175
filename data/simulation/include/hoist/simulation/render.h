#pragma once

#include <hoist/simulation/ray_caster.h>
#include <hoist/simulation/scene.h>

#include <opencv2/core.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace hoist {
namespace simulation {

/** \brief Directions of the rays of a lens, through pixels or between them. */
class Lens {
public:
  /** \param distortion k1 k2 p1 p2 k3 */
  Lens(const Intrinsics& camera, const std::array<double, 5>& distortion)
  : camera_(camera)
  , distortion_(distortion)
  , distorted_(distortion != std::array<double, 5>{})
  {
  }

  /** \brief The ray that the lens brings to pixel (u, v), scaled to z = 1. */
  Eigen::Vector3d ray(double u, double v) const;

  /** \brief Where the lens images a point of the camera frame, z > 0. */
  Eigen::Vector2d project(const Eigen::Vector3d& p) const;

private:
  Intrinsics camera_;
  std::array<double, 5> distortion_;
  bool distorted_;
};

/** \brief What the ray through the centre of every pixel met. */
struct PixelHits {
  cv::Size size;
  std::vector<Hit> hits; ///< row by row

  const Hit&
  operator()(int u, int v) const
  {
    return hits[static_cast<std::size_t>(v) * size.width + u];
  }
};

/** \brief Casts a ray through every pixel. \param pose camera to world */
PixelHits castPixels(const RayCaster& caster,
                     const Lens& lens,
                     const cv::Size& size,
                     const Eigen::Isometry3d& pose);

/** \brief What a camera sees, exactly, at the centre of every pixel. */
struct Layer {
  cv::Mat1i thing;            ///< index of the thing, -1 for nothing
  cv::Mat1b face;             ///< of its box, 255 for none
  cv::Mat1d depth;            ///< z [m]; NaN for nothing
  cv::Mat1f cosine;           ///< of the angle between the ray and the surface's normal
  cv::Mat_<cv::Vec3f> normal; ///< unit, camera frame, towards the camera
};

/** \brief What the pixels of a camera show. \param pose camera to world, as the rays
 *  were cast with */
Layer layerOf(const PixelHits& seen, const Lens& lens, const Eigen::Isometry3d& pose);

/** \brief How a picture is taken. */
struct Exposure {
  double error = 0;                         ///< against the automatic one [EV]
  std::array<double, 3> gain = {{1, 1, 1}}; ///< R G B, left over after balancing
  double noise = 1;         ///< factor on shot and read noise; 0 for none
  double vignetting = 0.15; ///< share of the light that is lost in the corners, [0, 1)
  double blur = 0.5;        ///< standard deviation [px]
  std::uint64_t seed = 0;
  /// Scene luminance (in units of Light's irradiances) that becomes middle grey; 0:
  /// what the picture itself asks for.
  double key = 0;
};

/** \brief A colour picture (BGR): sun with cast shadows, sky and lamps, exposure,
 * noise. \param seen castPixels() of this lens and pose \param key set to the luminance
 * that became middle grey, if not null */
cv::Mat3b photograph(const RayCaster& caster,
                     const Scene& scene,
                     const Lens& lens,
                     const PixelHits& seen,
                     const Eigen::Isometry3d& pose,
                     const Exposure& exposure,
                     double* key = nullptr);

} // namespace simulation
} // namespace hoist
