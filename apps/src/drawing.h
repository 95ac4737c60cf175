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

/** \brief A line of one pixel, for what must not cover the picture. */
void
drawThinLine(cv::Mat3b& image, cv::Point2f p, cv::Point2f q, const cv::Scalar& color);

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

/** \brief Text boxes that name rectangles without covering each other. */
class LabelPlacer {
public:
  /** \param canvas the picture's size: labels stay inside
   *  \param text_scale size of the text, 1 for a picture of 1280 columns */
  LabelPlacer(cv::Size canvas, int text_scale);

  /** \brief Adds a label near \a target; earlier labels have the better places. */
  void
  add(const std::vector<std::string>& lines, const cv::Rect& target, const cv::Scalar&);

  void draw(cv::Mat3b& image) const;

private:
  struct Label {
    std::vector<std::string> lines;
    cv::Rect box;
    cv::Rect target;
    cv::Scalar color;
  };

  double cost(const cv::Rect& box, const cv::Rect& target) const;

  cv::Size canvas_;
  int text_scale_;
  std::vector<Label> labels_;
};

} // namespace hoist
