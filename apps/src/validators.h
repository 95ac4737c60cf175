#pragma once

#include <hoist/data/sensor_model.h>

#include <opencv2/core.hpp>

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace hoist {

/** \brief Accepts finite numbers in [low, high]. CLI11's own Range lets NaN through. */
CLI::Validator numberIn(double low, double high);

/** \brief Accepts whole numbers in [low, high]. */
CLI::Validator integerIn(long low, long high);

/** \brief "kinect", "stereo:FB[,SIGMA]" or "constant:SIGMA".
 *  \throws CLI::ValidationError */
SensorModel parseSensor(const std::string& text);

/** \brief "u,v,w,h" in pixels: column and row of the top left corner, width, height.
 *  \throws CLI::ValidationError */
cv::Rect parseRegion(const std::string& text);

/** \brief Finite numbers separated by commas.
 *  \param option that they are for, e.g. "--support-plane"
 *  \param count how many, or how many to a group: then as many groups as there are
 *  \param meaning what is expected, for the message, e.g. "a,b,c,d"
 *  \throws CLI::ValidationError */
std::vector<double> parseNumbers(const std::string& option,
                                 const std::string& text,
                                 std::size_t count,
                                 const std::string& meaning,
                                 bool groups = false);

/** \brief "u,v": column and row of a pixel.
 *  \throws CLI::ValidationError */
cv::Point parsePixel(const std::string& text);

} // namespace hoist
