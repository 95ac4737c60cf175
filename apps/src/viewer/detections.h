#pragma once

#include <opencv2/core.hpp>

#include <string>
#include <vector>

namespace hoist {

/** \brief What a detector saw in a frame's picture. */
struct Detection {
  cv::Rect2d box; ///< [px]; left, top, width, height
  std::string label;
  double score = 0; ///< NaN where none is given
};

/** \brief Reads boxes: an array of {"box": [left, top, width, height], "class": ...,
 *  "score": ...}, or an object with such an array as "detections". Class (also "label")
 *  and score may be missing.
 *  \throws FileError naming the file and what is wrong */
std::vector<Detection> loadDetections(const std::string& file);

} // namespace hoist
