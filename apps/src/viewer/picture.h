#pragma once

#include "viewer/layers.h"
#include "viewer/scene.h"

#include <opencv2/core.hpp>

namespace hoist {

/** \brief How many pixels of the picture a pixel of the frame has. */
int pictureScale(const Scene& scene);

/** \brief The frame's picture with the layers that are shown; a dark card with words
 *  where there is no frame. */
cv::Mat3b
drawPicture(const Scene& scene, const LayerSet& layers, const Highlight& highlight);

} // namespace hoist
