#pragma once

#include <opencv2/core.hpp>

#include <cstddef>

namespace hoist {

/** \brief The colour of a frame's i-th cuboid, BGR, the same in all pictures.
 *
 * Ten colours far apart for every eye: chosen one after the other, each as far as
 * possible from all before in L*a*b*, least over normal, protanopic and deuteranopic
 * sight (Machado et al. 2009), light enough for a dark picture. */
inline cv::Scalar
cuboidColor(std::size_t i)
{
  static const cv::Scalar colors[] = {{0, 165, 225},
                                      {255, 0, 195},
                                      {255, 240, 0},
                                      {105, 0, 255},
                                      {180, 105, 135},
                                      {150, 255, 165},
                                      {180, 180, 255},
                                      {30, 75, 210},
                                      {255, 180, 30},
                                      {105, 135, 75}};
  return colors[i % (sizeof colors / sizeof *colors)];
}

const cv::Scalar color_edge_color(200, 200, 90);
const cv::Scalar occlusion_edge_color(60, 110, 255);
const cv::Scalar crease_edge_color(255, 110, 220);
const cv::Scalar segment_color(70, 235, 255);
const cv::Scalar vertex_color(255, 255, 255);

} // namespace hoist
