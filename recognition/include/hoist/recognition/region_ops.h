#pragma once

#include <hoist/recognition/export.h>

#include <opencv2/core.hpp>

#include <vector>

namespace hoist {

/** \brief Corners of a box [px]: left, top, right, bottom. */
using Corners = cv::Vec4f;

/** \brief Averages features in a grid over each region, as torchvision.ops.roi_align
 *  with aligned=False does (He et al., "Mask R-CNN", 2017, 3).
 *
 * \param features C x H x W or 1 x C x H x W, float
 * \param regions in pixels of the image
 * \param scale pixels of the features per pixel of the image, > 0
 * \param side of the answer's grid, > 0
 * \param samples per side of a cell of the grid, > 0
 * \param pooled regions x C x side x side; its memory is used again if it fits
 * \throws std::invalid_argument if the features or a number are none of that
 */
HOIST_RECOGNITION_EXPORT void roiAlign(const cv::Mat& features,
                                       const std::vector<Corners>& regions,
                                       double scale,
                                       int side,
                                       int samples,
                                       cv::Mat& pooled);

/** \brief Boxes that a network moves and stretches, as torchvision's BoxCoder (Ren et
 *  al., "Faster R-CNN", 2015, equation 2).
 *
 * \param anchor the box to start from
 * \param delta dx, dy, dw, dh; dw and dh are held below log(1000 / 16)
 * \param weights each delta is divided by its own, e.g. 10, 10, 5, 5
 */
HOIST_RECOGNITION_EXPORT Corners decodeBox(const Corners& anchor,
                                           const cv::Vec4f& delta,
                                           const cv::Vec4f& weights);

/** \brief Which boxes stay, best score first: one goes if it overlaps a better one by
 *  more than \a threshold (intersection over union). Of equal scores the first in the
 *  list is the better. As torchvision.ops.nms.
 *  \throws std::invalid_argument if the lists differ in length */
HOIST_RECOGNITION_EXPORT std::vector<int>
suppressOverlaps(const std::vector<Corners>& boxes,
                 const std::vector<float>& scores,
                 double threshold);

} // namespace hoist
