#pragma once

#include <opencv2/core.hpp>

#include <pcl/types.h>

#include <string>

namespace hoist {

/** \brief A thing that a detector saw in the image. */
struct Detection {
  std::string object_class;
  double score = 0; ///< (0, 1], how sure the detector is; not a probability
  /// In the frame's image [px], clipped to it; pixel i covers [i, i + 1].
  cv::Rect2d box;
  /// Measured pixels of the thing as indices into the cloud, ascending. A detector that
  /// says only boxes gives all measured pixels whose centre is in the box.
  pcl::Indices indices;
};

} // namespace hoist
