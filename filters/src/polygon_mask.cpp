#include <hoist/filters/polygon_mask.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hoist {

void
fillPolygon(const std::vector<cv::Point2f>& polygon, cv::Mat1b& mask)
{
  if (polygon.size() < 3)
    throw std::invalid_argument("hoist::RegionCrop: a polygon needs 3 corners");
  for (const auto& corner : polygon)
    if (!std::isfinite(corner.x) || !std::isfinite(corner.y))
      throw std::invalid_argument("hoist::RegionCrop: a corner is not finite");

  mask.setTo(0);
  std::vector<double> crossings;
  for (int v = 0; v < mask.rows; ++v) {
    crossings.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const cv::Point2d a = polygon[i], b = polygon[(i + 1) % polygon.size()];
      if ((a.y <= v) != (b.y <= v)) // half open, so that corners count once
        crossings.push_back(a.x + (v - a.y) / (b.y - a.y) * (b.x - a.x));
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const double first = std::max(0.0, std::ceil(crossings[i]));
      const double end = std::min<double>(mask.cols, std::ceil(crossings[i + 1]));
      for (int u = static_cast<int>(first); u < end; ++u)
        mask(v, u) = 255;
    }
  }
}

} // namespace hoist
