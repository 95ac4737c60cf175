#pragma once

#include "viewer/layers.h"
#include "viewer/scene.h"

#include <opencv2/core.hpp>

namespace hoist {

/** \brief How many pixels of the picture a pixel of the frame has. */
int pictureScale(const Scene& scene);

/** \brief The frame's picture with the layers that are shown; a dark card with words
 *  where there is no frame.
 *  \param selected number of the cuboid that is drawn stronger; -1 for none
 *  \param labels whether cuboids get their sizes beside them */
cv::Mat3b
drawPicture(const Scene& scene, const LayerSet& layers, int selected, bool labels);

} // namespace hoist
