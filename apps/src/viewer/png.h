#pragma once

#include <opencv2/core.hpp>

#include <string>

namespace hoist {

/** \brief Writes a picture so that readers see the old file or the new one.
 *  \throws pcl::IOException */
void savePng(const std::string& file, const cv::Mat3b& picture);

} // namespace hoist
