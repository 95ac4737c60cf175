#pragma once

#include "recognizer.h"

#include <string>

namespace hoist {

/** \brief A small JPEG of the frame with the cuboids' wireframes.
 *  \param width columns, > 0 */
std::string makeThumbnail(const Frame& frame, const FrameResult& result, int width);

} // namespace hoist
