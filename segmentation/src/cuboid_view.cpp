#include "cuboid_view.h"

#include <algorithm>
#include <cmath>

namespace hoist {
namespace detail {

PixelPlane
toPixels(const Eigen::Vector3d& n, double d, const Intrinsics& k)
{
  PixelPlane p;
  p.a = n.x() / (k.fx * d);
  p.b = n.y() / (k.fy * d);
  p.c = (n.z() - n.x() * k.cx / k.fx - n.y() * k.cy / k.fy) / d;
  return p;
}

CuboidView::CuboidView(const CuboidHypothesis& hypothesis,
                       const Intrinsics& intrinsics,
                       const SensorModel& sensor_model,
                       const cv::Size& image)
: box(hypothesis), camera(intrinsics), sensor(sensor_model)
{
  double u0 = image.width, u1 = -1, v0 = image.height, v1 = -1;
  for (int k = 0; k < 8; ++k) {
    Eigen::Vector3d local;
    for (int i = 0; i < 3; ++i)
      local[i] = (k >> i & 1) != 0 ? box.upper[i] : box.lower[i];
    const Eigen::Vector3d corner = box.axes * local;
    if (corner.z() < min_depth)
      return;
    const Eigen::Vector2d q = camera.project(corner);
    u0 = std::min(u0, q.x());
    u1 = std::max(u1, q.x());
    v0 = std::min(v0, q.y());
    v1 = std::max(v1, q.y());
  }
  pixel = box.center().z() / std::min(camera.fx, camera.fy);

  // A face is visible if the camera, the origin, lies beyond its plane. Hidden faces
  // are moved inwards, which pulls the outline in: depth is not trusted that near to
  // it.
  const double rim = 1.5 * pixel;
  for (int f = 0; f < 6; ++f) {
    constexpr double edge_on = 1e-4; // a plane through the camera has no inverse depth
    double d = box.end(f);
    if (CuboidHypothesis::side(f) * d < 0) {
      if (fronts == 3 || std::abs(d) < edge_on) {
        fronts = 0;
        return;
      }
      front[fronts++] = f;
    }
    else {
      // not past the camera, which would make it a visible one
      d = CuboidHypothesis::side(f) *
          std::max(edge_on,
                   CuboidHypothesis::side(f) * d -
                       std::min(rim, 0.25 * box.size()[f / 2]));
      hidden[n_hidden++] = f;
    }
    planes[f] = toPixels(box.axes.col(f / 2), d, camera);
  }
  left = std::max(0, static_cast<int>(std::ceil(std::max(u0, 0.0))));
  right = static_cast<int>(std::floor(std::min(u1, image.width - 1.0)));
  top = std::max(0, static_cast<int>(std::ceil(std::max(v0, 0.0))));
  bottom = static_cast<int>(std::floor(std::min(v1, image.height - 1.0)));
}

} // namespace detail
} // namespace hoist
