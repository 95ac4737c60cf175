#pragma once

#include "wireframe.h"

#include <opencv2/core.hpp>

#include <string>
#include <vector>

namespace hoist {

/** \brief How much larger than its frame a picture is drawn: 1280 columns at least, for
 *  words and thin lines to be readable. */
int enlargement(int frame_width);

/** \brief The scale of words (see textSize()) in a picture of that width. */
int textScaleOf(int picture_width);

/** \brief Pixels of cuboids take on some of their colours.
 *  \param owners which cuboid is seen at each pixel, -1 for none
 *  \param ink from 0 to 1, how much */
void tintCuboids(cv::Mat3b& picture, const cv::Mat1i& owners, double ink);

/** \brief Cuboids' edges in their colours: hidden pieces thin and dashed under all seen
 *  ones.
 *  \param scale pixels of the picture per pixel of the frame
 *  \param thickness of the seen pieces of every cuboid [px] */
void drawCuboidEdges(cv::Mat3b& picture,
                     const std::vector<std::vector<EdgePiece>>& edges,
                     int scale,
                     const std::vector<int>& thickness);

/** \brief Number and sizes as a label has them: "#2  20.1 x 15.0 x >9.8 cm". */
std::string numberAndSizes(const Cuboid& cuboid, std::size_t index);

} // namespace hoist
