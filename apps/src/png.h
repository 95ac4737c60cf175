#pragma once

#include <opencv2/core.hpp>

#include <string>

namespace hoist {

/** \brief A picture as a PNG file holds it; of one, three or four channels of 8 or 16
 *  bits.
 *  \param effort of packing, 0 to 9 (smallest); -1: OpenCV's own, the fastest that
 *         packs
 *  \throws pcl::IOException if it cannot be packed */
std::string pngBytes(const cv::Mat& picture, int effort = -1);

/** \brief Writes a picture so that readers see the old file or the new one.
 *  \throws pcl::IOException */
void savePng(const std::string& file, const cv::Mat& picture, int effort = -1);

} // namespace hoist
