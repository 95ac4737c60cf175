#pragma once

#include <hoist/simulation/scene.h>

#include <Eigen/Core>

#include <cstdint>
#include <limits>
#include <memory>

namespace hoist {
namespace simulation {

/** \brief Where a ray meets the scene. */
struct Hit {
  double distance = std::numeric_limits<double>::infinity(); ///< in ray lengths
  int thing = -1;                                            ///< index, -1 for nothing
  std::uint32_t triangle = 0;                                ///< of the thing's mesh
  std::uint8_t face = 255;                                   ///< see Mesh::Triangle
  Eigen::Vector3d normal =
      Eigen::Vector3d::Zero(); ///< of the triangle, towards the eye
  float u = 0, v = 0;          ///< barycentric: 2nd, 3rd corner
};

/** \brief Casts rays at a scene with Embree.
 *
 * Embree finds the triangle; the distance is then the plane's, in double, so that a
 * depth is that of the geometry to 1e-9 of it. Every query gives the same answer at any
 * number of threads and on every processor: the tree is built by one thread, and all
 * use SSE4.2, which all x86 processors of the last ten years have, and none more.
 * Queries may run in parallel.
 */
class RayCaster {
public:
  /** \throws std::runtime_error if Embree fails, e.g. for want of memory;
   *  std::invalid_argument if the camera is none or its pose is not finite */
  explicit RayCaster(const Scene& scene);
  ~RayCaster();
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  /** \brief The nearest triangle on origin + distance * direction, distance > 0. */
  Hit cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;

  /** \brief Four rays from one origin at once: the same answers, in half the time. */
  void cast4(const Eigen::Vector3d& origin,
             const Eigen::Vector3d* directions,
             Hit* hits) const;

  /** \brief Whether anything lies on origin + t * direction for 0 < t < \a far. */
  bool blocked(const Eigen::Vector3d& origin,
               const Eigen::Vector3d& direction,
               double far = std::numeric_limits<double>::infinity()) const;

  /** \brief The same for four rays. */
  void blocked4(const Eigen::Vector3d* origins,
                const Eigen::Vector3d* directions,
                const double* fars,
                bool* blocked) const;

  /** \brief Whether the ray would meet the thing if nothing else were there; false for
   *  what is not annotated, of which nobody asks. */
  bool meets(int thing,
             const Eigen::Vector3d& origin,
             const Eigen::Vector3d& direction) const;

  /** \brief Shading normal of a hit, unit, towards the eye as hit.normal is. */
  Eigen::Vector3d shadingNormal(const Hit& hit) const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace simulation
} // namespace hoist
