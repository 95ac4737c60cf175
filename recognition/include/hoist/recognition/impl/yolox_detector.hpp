#pragma once

#include <hoist/recognition/yolox_detector.h>

#include <pcl/common/point_tests.h>
#include <pcl/console/print.h>

#include <algorithm>
#include <cmath>

namespace hoist {

template <typename PointT>
bool
YoloxDetector<PointT>::detect(std::vector<Detection>& detections)
{
  detections.clear();
  if (!initCompute()) {
    PCL_ERROR("[hoist::YoloxDetector] no input cloud\n");
    return false;
  }
  const auto fail = [&](const char* reason) {
    PCL_ERROR("[hoist::YoloxDetector] %s\n", reason);
    deinitCompute();
    return false;
  };
  if (input_->height < 2)
    return fail("the cloud is not organized");
  std::vector<bool> given(input_->size(), false);
  for (const pcl::index_t i : *indices_) {
    if (i < 0 || static_cast<std::size_t>(i) >= input_->size())
      return fail("an index is outside of the cloud");
    given[static_cast<std::size_t>(i)] = true;
  }
  toFrameImages(*input_, images_);
  if (images_.bgr.empty())
    return fail("the cloud has no colour");

  const int width = static_cast<int>(input_->width);
  for (Detection& detection :
       network_.detect(images_.bgr, score_threshold_, overlap_threshold_)) {
    const cv::Rect2d& box = detection.box;
    // pixels whose centre, at i + 0.5, is in the box
    const int left = static_cast<int>(std::ceil(box.x - 0.5));
    const int top = static_cast<int>(std::ceil(box.y - 0.5));
    for (int v = top; v + 0.5 < box.y + box.height; ++v)
      for (int u = left; u + 0.5 < box.x + box.width; ++u) {
        const int i = v * width + u;
        if (given[static_cast<std::size_t>(i)] &&
            pcl::isXYZFinite((*input_)[static_cast<std::size_t>(i)]))
          detection.indices.push_back(i);
      }
    // nothing measured is still something seen; nothing asked for is left out
    const bool whole = indices_->size() == input_->size();
    if (whole || !detection.indices.empty())
      detections.push_back(std::move(detection));
  }
  deinitCompute();
  return true;
}

} // namespace hoist

#define PCL_INSTANTIATE_HoistYoloxDetector(T)                                          \
  template class HOIST_RECOGNITION_EXPORT hoist::YoloxDetector<T>;
