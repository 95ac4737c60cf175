#pragma once

#include "recognizer.h"

#include <string>

namespace hoist {

/** \brief In words, what the full mode thought at a pixel of the frame that was
 *  recognised last: what was measured, the flat face there, the boxes that cover it,
 *  the best three, and what rejected each. Lines end in a line feed.
 *  \throws UsageError if the pixel lies outside the frame */
std::string
whyText(const Recognizer& recognizer, const Frame& frame, const cv::Point& pixel);

} // namespace hoist
