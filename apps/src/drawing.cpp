#include "drawing.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace hoist {
namespace {

constexpr int font = cv::FONT_HERSHEY_SIMPLEX;
constexpr double font_scale =
    0.5;                         // times text_scale: capitals of 11 px at 1280 columns
constexpr int fraction_bits = 4; // sub-pixel positions for OpenCV's lines

const cv::Scalar rim(20, 20, 20);
const cv::Scalar panel(32, 28, 26);
const cv::Scalar ink(245, 245, 245);

cv::Point
fixed(cv::Point2f p)
{
  constexpr float one = 1 << fraction_bits;
  return {cvRound(p.x * one), cvRound(p.y * one)};
}

} // namespace

cv::Size
textSize(const std::string& text, int text_scale)
{
  int baseline = 0;
  return cv::getTextSize(text, font, font_scale * text_scale, text_scale, &baseline);
}

void
drawText(cv::Mat3b& image, const std::string& text, cv::Point at, int text_scale)
{
  cv::putText(
      image, text, at, font, font_scale * text_scale, ink, text_scale, cv::LINE_AA);
}

void
drawHaloLine(cv::Mat3b& image,
             cv::Point2f p,
             cv::Point2f q,
             const cv::Scalar& color,
             int thickness)
{
  cv::line(image, fixed(p), fixed(q), rim, thickness + 2, cv::LINE_AA, fraction_bits);
  cv::line(image, fixed(p), fixed(q), color, thickness, cv::LINE_AA, fraction_bits);
}

void
drawDashedLine(cv::Mat3b& image,
               cv::Point2f p,
               cv::Point2f q,
               const cv::Scalar& color,
               int thickness,
               int dash)
{
  const cv::Point2f way = q - p;
  const auto length = static_cast<float>(cv::norm(way));
  // an odd number of equal pieces: the line begins and ends with a dash
  const int pieces = std::min(2 * static_cast<int>(length / (2.0f * dash)) + 1, 2001);
  for (int i = 0; i < pieces; i += 2) {
    const cv::Point2f a = p + way * (static_cast<float>(i) / pieces);
    const cv::Point2f b = p + way * (static_cast<float>(i + 1) / pieces);
    cv::line(image, fixed(a), fixed(b), color, thickness, cv::LINE_AA, fraction_bits);
  }
}

cv::Mat3b
drawFooter(const std::string& title,
           const std::vector<LegendEntry>& legend,
           int width,
           int text_scale)
{
  const int row = 30 * text_scale, margin = 12 * text_scale, mark = 14 * text_scale;
  int legend_width = 0;
  for (const LegendEntry& entry : legend)
    legend_width += mark + textSize(entry.text, text_scale).width + 2 * margin;
  const int title_width = textSize(title, text_scale).width + 2 * margin;
  const bool two_rows = !legend.empty() && title_width + legend_width > width;

  cv::Mat3b strip(row * (two_rows ? 2 : 1), width, cv::Vec3b());
  strip.setTo(panel);
  const auto baseline = [&](int r) { return r * row + row / 2 + 5 * text_scale; };
  drawText(strip, title, {margin, baseline(0)}, text_scale);

  const int r = two_rows ? 1 : 0;
  int x = two_rows ? margin : width - legend_width;
  for (const LegendEntry& entry : legend) {
    const cv::Point centre(x + mark / 2, r * row + row / 2);
    if (entry.mark == LegendMark::square)
      cv::rectangle(strip,
                    cv::Rect(centre.x - 4 * text_scale,
                             centre.y - 4 * text_scale,
                             8 * text_scale,
                             8 * text_scale),
                    entry.color,
                    cv::FILLED);
    else if (entry.mark == LegendMark::line)
      cv::line(strip,
               {centre.x - mark / 2, centre.y},
               {centre.x + mark / 2, centre.y},
               entry.color,
               2 * text_scale,
               cv::LINE_AA);
    else
      cv::circle(strip, centre, 4 * text_scale, entry.color, text_scale, cv::LINE_AA);
    x += mark + margin / 2;
    drawText(strip, entry.text, {x, baseline(r)}, text_scale);
    x += textSize(entry.text, text_scale).width + margin + margin / 2;
  }
  return strip;
}

} // namespace hoist
