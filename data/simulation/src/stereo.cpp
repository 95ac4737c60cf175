#include <hoist/simulation/measure.h>

#include <opencv2/calib3d.hpp>

#include <limits>

namespace hoist {
namespace simulation {

cv::Mat1f
matchStereo(const Sensor& sensor, const cv::Mat1b& reference, const cv::Mat1b& other)
{
  // The matcher's reference is a left eye; ours is the right one: in a mirror they
  // swap.
  cv::Mat1b left, right;
  cv::flip(reference, left, 1);
  cv::flip(other, right, 1);
  const int area = sensor.block_size * sensor.block_size;
  // a quarter of the smoothness of OpenCV's example: more would flatten what stands far
  // away, where a thing differs from the ground by a pixel of disparity
  const auto matcher = cv::StereoSGBM::create(0,
                                              sensor.max_disparity,
                                              sensor.block_size,
                                              2 * area,
                                              8 * area,
                                              /*disp12MaxDiff=*/1,
                                              /*preFilterCap=*/31,
                                              /*uniquenessRatio=*/8,
                                              /*speckleWindowSize=*/80,
                                              /*speckleRange=*/2,
                                              cv::StereoSGBM::MODE_SGBM_3WAY);
  cv::Mat1s mirrored, disparity;
  matcher->compute(left, right, mirrored);
  cv::flip(mirrored, disparity, 1);

  cv::Mat1f depth(disparity.size(), std::numeric_limits<float>::quiet_NaN());
  const double focal_baseline = sensor.believed().fx * sensor.baseline;
  for (int v = 0; v < depth.rows; ++v)
    for (int u = 0; u < depth.cols; ++u) {
      const double d = disparity(v, u) / 16.0;
      if (d <= 0)
        continue;
      const double z = focal_baseline / d;
      if (z >= sensor.min_range && z <= sensor.max_range)
        depth(v, u) = static_cast<float>(z);
    }
  return depth;
}

} // namespace simulation
} // namespace hoist
