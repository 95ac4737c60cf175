#pragma once

#include <hoist/data/sensor_model.h>

#include <opencv2/core.hpp>

#include <CLI/CLI.hpp>

#include <string>

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

/** \brief "u,v": column and row of a pixel.
 *  \throws CLI::ValidationError */
cv::Point parsePixel(const std::string& text);

} // namespace hoist
