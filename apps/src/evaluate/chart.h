#pragma once

#include <opencv2/core.hpp>

#include <array>
#include <string>
#include <vector>

namespace hoist {

/** \brief Colours that every eye tells apart (Okabe and Ito), the first five of them.
 */
cv::Scalar chartColor(std::size_t number);

/** \brief A diagram of lines, points and bars over two linear axes, as a picture of
 *  520 x 400. Numbers that are not finite are left out. */
class Chart {
public:
  using Points = std::vector<std::array<double, 2>>;

  Chart(std::string title, std::string x_label, std::string y_label);

  /** \param high if it is not above \a low, low + 1 is taken */
  void setRangeX(double low, double high);
  void setRangeY(double low, double high);

  /** \param name in the legend, "" for none */
  void addLine(const Points& points,
               const cv::Scalar& color,
               const std::string& name,
               bool dashed = false);

  /** \brief A line with a dot at every point. */
  void addDots(const Points& points, const cv::Scalar& color, const std::string& name);

  /** \brief A bar from 0 up. */
  void addBar(double from, double to, double height, const cv::Scalar& color);

  cv::Mat3b draw() const;

private:
  struct Series {
    Points points;
    cv::Scalar color;
    std::string name;
    bool dashed = false;
    bool dots = false;
  };
  struct Bar {
    double from, to, height;
    cv::Scalar color;
  };

  cv::Point2f place(double x, double y) const;
  void drawAxes(cv::Mat3b& image) const;
  void drawSeries(cv::Mat3b& image, const Series& series) const;
  void drawLegend(cv::Mat3b& image, const cv::Mat1b& drawn) const;

  std::string title_, x_label_, y_label_;
  double x_low_ = 0, x_high_ = 1, y_low_ = 0, y_high_ = 1;
  std::vector<Series> series_;
  std::vector<Bar> bars_;
};

/** \brief Diagrams in a row. */
cv::Mat3b besideEachOther(const std::vector<Chart>& charts);

} // namespace hoist
