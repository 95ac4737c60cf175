#pragma once

#include <hoist/data/frame_images.h>

#include <opencv2/core.hpp>

namespace hoist {

/** \brief The frame's colours, or its depth as grey where it has none, enlarged and
 *  brought to one brightness on which lines can be seen. */
cv::Mat3b background(const FrameImages& images, int scale);

} // namespace hoist
