#include <hoist/filters/canny.h>

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace hoist {
namespace {

// Largest magnitude of a 3 x 3 Sobel gradient of 8 bit values: sqrt(2) * 4 * 255.
constexpr int max_magnitude = 1443;

void
check(bool condition, const char* what)
{
  if (!condition)
    throw std::invalid_argument(std::string("hoist::Canny: ") + what);
}

void
check(const CannyParameters& p)
{
  check(p.threshold_scale > 0, "threshold_scale must be > 0");
  if (p.auto_threshold) {
    check(p.edge_share > 0 && p.edge_share < 1, "edge_share must be in (0, 1)");
    check(p.noise_factor >= 0, "noise_factor must be >= 0");
    check(p.low_ratio > 0 && p.low_ratio <= 1, "low_ratio must be in (0, 1]");
  }
  else
    check(p.high > 0 && p.low > 0 && p.low <= p.high, "needs 0 < low <= high");
  if (p.remove_texture) {
    check(p.texture_window >= 0, "texture_window must be >= 0");
    check(p.texture_density > 0 && p.texture_density <= 1,
          "texture_density must be in (0, 1]");
    check(p.straight_length >= 0, "straight_length must be >= 0");
  }
}

} // namespace

void
Canny::setImage(const cv::Mat1b& gray, double blur_sigma)
{
  check(blur_sigma >= 0 && blur_sigma <= 5, "blur_sigma must be in [0, 5]");
  if (gray.empty()) {
    dx_.release();
    dy_.release();
    return;
  }
  if (blur_sigma > 0) {
    const int side = 2 * std::max(1, cvRound(2 * blur_sigma)) + 1;
    cv::GaussianBlur(gray, blurred_, {side, side}, blur_sigma);
  }
  cv::spatialGradient(blur_sigma > 0 ? blurred_ : gray, dx_, dy_);
}

void
Canny::detect(const CannyParameters& parameters, cv::Mat1b& edges)
{
  check(parameters);
  if (dx_.empty()) {
    edges.release();
    return;
  }
  chooseThresholds(parameters);
  cv::Canny(dx_, dy_, edges, low_, high_, true);
  // A gradient on the border is a guess of the border rule.
  cv::rectangle(edges, {0, 0, edges.cols, edges.rows}, 0);
  if (parameters.remove_texture)
    texture_.remove(
        dx_,
        dy_,
        {parameters.texture_window > 0 ? parameters.texture_window : edges.cols / 40,
         parameters.texture_density,
         parameters.straight_length > 0 ? parameters.straight_length
                                        : edges.cols / 32.0},
        edges);
}

void
Canny::chooseThresholds(const CannyParameters& parameters)
{
  high_ = parameters.high;
  low_ = parameters.low;
  if (parameters.auto_threshold) {
    // every second pixel of every second row is plenty for a quantile
    histogram_.assign(max_magnitude + 2, 0);
    int samples = 0;
    for (int v = 0; v < dx_.rows; v += 2) {
      const short* dx = dx_[v];
      const short* dy = dy_[v];
      for (int u = 0; u < dx_.cols; u += 2)
        ++histogram_[static_cast<int>(
            std::sqrt(static_cast<float>(dx[u] * dx[u] + dy[u] * dy[u])))];
      samples += (dx_.cols + 1) / 2;
    }
    const auto quantile = [&](double q) {
      const double wanted = q * samples;
      int m = 0;
      for (double seen = histogram_[0]; seen < wanted && m < max_magnitude;)
        seen += histogram_[++m];
      return m + 1; // the bin's upper end
    };
    high_ = std::max<double>(quantile(1 - parameters.edge_share),
                             parameters.noise_factor * quantile(0.5));
    low_ = parameters.low_ratio * high_;
  }
  high_ *= parameters.threshold_scale;
  low_ *= parameters.threshold_scale;
}

} // namespace hoist
