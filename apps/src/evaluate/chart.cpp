#include "evaluate/chart.h"

#include "drawing.h"

#include <opencv2/imgproc.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace hoist {
namespace {

// Drawn at twice the size and then made smaller: OpenCV's letters get smooth.
constexpr int fine = 2;
constexpr int width = 520 * fine, height = 400 * fine;
constexpr int left = 66 * fine, right = 18 * fine, top = 40 * fine, bottom = 58 * fine;
constexpr int font = cv::FONT_HERSHEY_SIMPLEX;
constexpr double letter = 0.42 * fine;
constexpr int fraction_bits = 4;

const cv::Scalar ink(40, 40, 40);
const cv::Scalar faint(225, 225, 225);
const cv::Scalar paper(255, 255, 255);

cv::Point
fixed(cv::Point2f p)
{
  constexpr float one = 1 << fraction_bits;
  return {cvRound(p.x * one), cvRound(p.y * one)};
}

cv::Size
sizeOf(const std::string& text, double scale)
{
  int baseline = 0;
  return cv::getTextSize(text, font, scale, fine, &baseline);
}

void
put(cv::Mat3b& image, const std::string& text, cv::Point at, double scale = letter)
{
  cv::putText(image, text, at, font, scale, ink, fine, cv::LINE_AA);
}

// 1, 2 or 5 times a power of ten, so that there are four to ten of them.
double
tickStep(double range)
{
  const double power = std::pow(10, std::floor(std::log10(range / 4)));
  for (const double factor : {5.0, 2.0, 1.0})
    if (range / (factor * power) >= 4)
      return factor * power;
  return power;
}

std::vector<double>
ticks(double low, double high)
{
  std::vector<double> all;
  const double step = tickStep(high - low);
  const double first = std::ceil(low / step - 1e-9);
  for (int i = 0; i <= 12; ++i) {
    const double value = (first + i) * step;
    if (value > high + 1e-9 * step)
      break;
    all.push_back(value);
  }
  return all;
}

} // namespace

cv::Scalar
chartColor(std::size_t number)
{
  static const std::array<cv::Scalar, 5> colors = {cv::Scalar(178, 114, 0),
                                                   cv::Scalar(0, 94, 213),
                                                   cv::Scalar(115, 158, 0),
                                                   cv::Scalar(167, 121, 204),
                                                   cv::Scalar(0, 159, 230)};
  return colors[number % colors.size()];
}

Chart::Chart(std::string title, std::string x_label, std::string y_label)
: title_(std::move(title)), x_label_(std::move(x_label)), y_label_(std::move(y_label))
{
}

void
Chart::setRangeX(double low, double high)
{
  x_low_ = low;
  x_high_ = high > low && std::isfinite(high) ? high : low + 1;
}

void
Chart::setRangeY(double low, double high)
{
  y_low_ = low;
  y_high_ = high > low && std::isfinite(high) ? high : low + 1;
}

void
Chart::addLine(const Points& points,
               const cv::Scalar& color,
               const std::string& name,
               bool dashed)
{
  series_.push_back({points, color, name, dashed, false});
}

void
Chart::addDots(const Points& points, const cv::Scalar& color, const std::string& name)
{
  series_.push_back({points, color, name, false, true});
}

void
Chart::addBar(double from, double to, double high, const cv::Scalar& color)
{
  bars_.push_back({from, to, high, color});
}

cv::Point2f
Chart::place(double x, double y) const
{
  // far outside is as good as just outside, and no coordinate overflows
  const double u = std::clamp((x - x_low_) / (x_high_ - x_low_), -1.0, 2.0);
  const double v = std::clamp((y - y_low_) / (y_high_ - y_low_), -1.0, 2.0);
  return {static_cast<float>(left + u * (width - left - right)),
          static_cast<float>(height - bottom - v * (height - top - bottom))};
}

void
Chart::drawAxes(cv::Mat3b& image) const
{
  for (const double x : ticks(x_low_, x_high_)) {
    const cv::Point2f p = place(x, y_low_), q = place(x, y_high_);
    cv::line(image, fixed(p), fixed(q), faint, fine, cv::LINE_AA, fraction_bits);
    const std::string text = fmt::format("{:.4g}", std::abs(x) < 1e-12 ? 0 : x);
    put(image,
        text,
        cv::Point(p) + cv::Point(-sizeOf(text, letter).width / 2, 17 * fine));
  }
  for (const double y : ticks(y_low_, y_high_)) {
    const cv::Point2f p = place(x_low_, y), q = place(x_high_, y);
    cv::line(image, fixed(p), fixed(q), faint, fine, cv::LINE_AA, fraction_bits);
    const std::string text = fmt::format("{:.4g}", std::abs(y) < 1e-12 ? 0 : y);
    const cv::Size size = sizeOf(text, letter);
    put(image, text, cv::Point(p) + cv::Point(-size.width - 6 * fine, size.height / 2));
  }
}

void
Chart::drawSeries(cv::Mat3b& image, const Series& series) const
{
  cv::Point2f last;
  bool has_last = false;
  for (const auto& [x, y] : series.points) {
    if (!std::isfinite(x) || !std::isfinite(y)) {
      has_last = false;
      continue;
    }
    const cv::Point2f p = place(x, y);
    if (has_last && series.dashed)
      drawDashedLine(image, last, p, series.color, 2 * fine, 7 * fine);
    else if (has_last)
      cv::line(image,
               fixed(last),
               fixed(p),
               series.color,
               2 * fine,
               cv::LINE_AA,
               fraction_bits);
    if (series.dots)
      cv::circle(image, p, 4 * fine, series.color, cv::FILLED, cv::LINE_AA);
    last = p;
    has_last = true;
  }
}

void
Chart::drawLegend(cv::Mat3b& image, const cv::Mat1b& drawn) const
{
  int rows = 0, widest = 0;
  for (const Series& series : series_)
    if (!series.name.empty()) {
      ++rows;
      widest = std::max(widest, sizeOf(series.name, letter).width);
    }
  if (rows == 0)
    return;
  const cv::Size size(widest + 40 * fine, (rows * 18 + 8) * fine);
  // the corner where it covers the least
  const int far_x = width - right - size.width - 6 * fine, near_x = left + 6 * fine;
  const int far_y = height - bottom - size.height - 8 * fine, near_y = top + 6 * fine;
  const cv::Rect whole(0, 0, width, height);
  cv::Rect box;
  int least = -1;
  for (const cv::Point corner : {cv::Point(far_x, far_y),
                                 cv::Point(near_x, near_y),
                                 cv::Point(far_x, near_y),
                                 cv::Point(near_x, far_y)}) {
    const int covered = cv::countNonZero(drawn(cv::Rect(corner, size) & whole));
    if (least < 0 || covered < least) {
      least = covered;
      box = cv::Rect(corner, size);
    }
  }
  image(box & whole).setTo(paper); // a long name may not fit
  cv::rectangle(image, box, faint, fine);
  int row = 0;
  for (const Series& series : series_) {
    if (series.name.empty())
      continue;
    const int y = box.y + (row++ * 18 + 13) * fine;
    const cv::Point a(box.x + 6 * fine, y), b(box.x + 28 * fine, y);
    if (series.dashed)
      drawDashedLine(image, a, b, series.color, 2 * fine, 5 * fine);
    else
      cv::line(image, a, b, series.color, 2 * fine, cv::LINE_AA);
    if (series.dots)
      cv::circle(image, (a + b) / 2, 4 * fine, series.color, cv::FILLED, cv::LINE_AA);
    put(image, series.name, {box.x + 34 * fine, y + 4 * fine});
  }
}

cv::Mat3b
Chart::draw() const
{
  cv::Mat3b image(height, width, cv::Vec3b(255, 255, 255));
  drawAxes(image);
  const cv::Rect inner(left, top, width - left - right, height - top - bottom);
  // what leaves the range is cut at the frame, but for the rims of dots
  const cv::Rect open(inner.x - 5 * fine,
                      inner.y - 5 * fine,
                      inner.width + 10 * fine,
                      inner.height + 10 * fine);
  const cv::Mat3b axes = image.clone();
  cv::Mat3b picture = image.clone();
  for (const Bar& bar : bars_) {
    const cv::Point2f p = place(bar.from, 0), q = place(bar.to, bar.height);
    cv::rectangle(picture, cv::Point(p), cv::Point(q), bar.color, cv::FILLED);
    cv::rectangle(picture, cv::Point(p), cv::Point(q), paper, fine);
  }
  for (const bool dots : {false, true}) {
    for (const Series& series : series_)
      if (series.dots == dots)
        drawSeries(picture, series);
    const cv::Rect& part = dots ? open : inner;
    picture(part).copyTo(image(part));
    picture = image.clone();
  }
  cv::Mat1b drawn;
  cv::Mat difference;
  cv::absdiff(image, axes, difference);
  cv::cvtColor(difference, drawn, cv::COLOR_BGR2GRAY);
  cv::rectangle(image, inner, ink, fine);
  drawLegend(image, drawn);

  put(image, title_, {left, 24 * fine}, 0.5 * fine);
  const cv::Size x_size = sizeOf(x_label_, letter);
  put(image,
      x_label_,
      {left + (inner.width - x_size.width) / 2, height - bottom + 38 * fine});
  const cv::Size y_size = sizeOf(y_label_, letter);
  cv::Mat3b side(y_size.height * 2, y_size.width + 2 * fine, cv::Vec3b(255, 255, 255));
  put(side, y_label_, {0, y_size.height + y_size.height / 2});
  cv::rotate(side, side, cv::ROTATE_90_COUNTERCLOCKWISE);
  const int y = std::max(0, top + (inner.height - side.rows) / 2);
  side = side.rowRange(0, std::min(side.rows, height - y));
  side.copyTo(image(cv::Rect(4 * fine, y, side.cols, side.rows)));
  cv::Mat3b out;
  cv::resize(image, out, {}, 1.0 / fine, 1.0 / fine, cv::INTER_AREA);
  return out;
}

cv::Mat3b
besideEachOther(const std::vector<Chart>& charts)
{
  std::vector<cv::Mat> pictures;
  pictures.reserve(charts.size());
  for (const Chart& chart : charts)
    pictures.emplace_back(chart.draw());
  cv::Mat3b out;
  cv::hconcat(pictures, out);
  return out;
}

} // namespace hoist
