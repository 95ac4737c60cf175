#pragma once

#include <opencv2/core.hpp>

#include <string>
#include <vector>

namespace hoist {

/** \brief A line with a dark rim, readable on any picture. */
void drawHaloLine(cv::Mat3b& image,
                  cv::Point2f p,
                  cv::Point2f q,
                  const cv::Scalar& color,
                  int thickness);

/** \brief Size of a line of text; \a text_scale is 1 for a picture of 1280 columns. */
cv::Size textSize(const std::string& text, int text_scale);

/** \brief White text, its baseline beginning at \a at. */
void drawText(cv::Mat3b& image, const std::string& text, cv::Point at, int text_scale);

/** \brief A dashed line; dashes and gaps are \a dash pixels long. */
void drawDashedLine(cv::Mat3b& image,
                    cv::Point2f p,
                    cv::Point2f q,
                    const cv::Scalar& color,
                    int thickness,
                    int dash);

enum class LegendMark { square, line, ring };

struct LegendEntry {
  std::string text;
  cv::Scalar color;
  LegendMark mark;
};

/** \brief A dark strip with a title on the left and a legend on the right; the legend
 *  goes into a second row where one is too short. */
cv::Mat3b drawFooter(const std::string& title,
                     const std::vector<LegendEntry>& legend,
                     int width,
                     int text_scale);

} // namespace hoist
