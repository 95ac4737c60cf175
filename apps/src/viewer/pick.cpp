#include "viewer/pick.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hoist {

int
pickPoint(const FrameImages& images, const SightLine& line)
{
  struct Met {
    int index;
    double along, off;
  };
  std::vector<Met> met;
  double first = std::numeric_limits<double>::infinity();
  for (int v = 0; v < images.height(); ++v)
    for (int u = 0; u < images.width(); ++u) {
      const cv::Vec3f& p = images.points(v, u);
      if (!(images.inverse_depth(v, u) > 0))
        continue;
      const Eigen::Vector3d to = Eigen::Vector3d(p[0], p[1], p[2]) - line.origin;
      const double along = to.dot(line.way);
      const double off = (to - along * line.way).norm();
      if (along <= 0 || off > line.slope * along)
        continue;
      met.push_back({v * images.width() + u, along, off});
      first = std::min(first, along);
    }
  // Of the surface in front the point that is aimed at, relative to its distance.
  int best = -1;
  double least = std::numeric_limits<double>::infinity();
  constexpr double surface = 1.03; // this much further is the same surface
  for (const Met& m : met)
    if (m.along <= surface * first && m.off / m.along < least) {
      least = m.off / m.along;
      best = m.index;
    }
  return best;
}

int
pickCuboid(const std::vector<Cuboid>& cuboids, const SightLine& line, double* distance)
{
  int best = -1;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < cuboids.size(); ++i) {
    const Cuboid& c = cuboids[i];
    const Eigen::Vector3d origin = c.axes.transpose() * (line.origin - c.center);
    const Eigen::Vector3d way = c.axes.transpose() * line.way;
    double in = 0, out = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
      const double half = 0.5 * c.size[k];
      if (way[k] == 0) {
        if (std::abs(origin[k]) > half)
          out = -1;
        continue;
      }
      const double a = (-half - origin[k]) / way[k], b = (half - origin[k]) / way[k];
      in = std::max(in, std::min(a, b));
      out = std::min(out, std::max(a, b));
    }
    if (in <= out && in < nearest) {
      nearest = in;
      best = static_cast<int>(i);
    }
  }
  if (distance != nullptr)
    *distance = nearest;
  return best;
}

} // namespace hoist
