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

cv::Size
textSize(const std::string& text, int text_scale)
{
  int baseline = 0;
  return cv::getTextSize(text, font, font_scale * text_scale, text_scale, &baseline);
}

void
putLine(cv::Mat3b& image, const std::string& text, cv::Point at, int text_scale)
{
  cv::putText(
      image, text, at, font, font_scale * text_scale, ink, text_scale, cv::LINE_AA);
}

} // namespace

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
drawThinLine(cv::Mat3b& image, cv::Point2f p, cv::Point2f q, const cv::Scalar& color)
{
  cv::line(image, fixed(p), fixed(q), color, 1, cv::LINE_AA, fraction_bits);
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
  putLine(strip, title, {margin, baseline(0)}, text_scale);

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
    putLine(strip, entry.text, {x, baseline(r)}, text_scale);
    x += textSize(entry.text, text_scale).width + margin + margin / 2;
  }
  return strip;
}

LabelPlacer::LabelPlacer(cv::Size canvas, int text_scale)
: canvas_(canvas), text_scale_(text_scale)
{
}

double
LabelPlacer::cost(const cv::Rect& box, const cv::Rect& target) const
{
  double covered = 0;
  for (const Label& other : labels_)
    covered += (box & other.box).area() + 0.3 * (box & other.target).area();
  const cv::Point from(box.x + box.width / 2, box.y + box.height / 2);
  const cv::Point to(target.x + target.width / 2, target.y + target.height / 2);
  return covered + 0.5 * (box & target).area() + 4.0 * cv::norm(from - to);
}

void
LabelPlacer::add(const std::vector<std::string>& lines,
                 const cv::Rect& target,
                 const cv::Scalar& color)
{
  const int pad = 7 * text_scale_, line = 19 * text_scale_;
  int width = 0;
  for (const std::string& text : lines)
    width = std::max(width, textSize(text, text_scale_).width);
  const cv::Size size(width + 2 * pad + 4 * text_scale_,
                      static_cast<int>(lines.size()) * line + pad);

  // Above, below, beside, and the same further away.
  cv::Rect best;
  double best_cost = 0;
  for (const int gap : {6, 30, 60, 110, 180})
    for (const double along : {0.5, 0.0, 1.0, 0.25, 0.75})
      for (int side = 0; side < 4; ++side) {
        const int distance = gap * text_scale_;
        cv::Point at;
        if (side < 2)
          at = {target.x + static_cast<int>(along * (target.width - size.width)),
                side == 0 ? target.y - size.height - distance
                          : target.y + target.height + distance};
        else
          at = {side == 2 ? target.x + target.width + distance
                          : target.x - size.width - distance,
                target.y + static_cast<int>(along * (target.height - size.height))};
        at.x = std::clamp(at.x, 2, std::max(2, canvas_.width - size.width - 2));
        at.y = std::clamp(at.y, 2, std::max(2, canvas_.height - size.height - 2));
        const cv::Rect box(at, size);
        const double c = cost(box, target);
        if (best.empty() || c < best_cost) {
          best = box;
          best_cost = c;
        }
      }
  labels_.push_back({lines, best, target, color});
}

void
LabelPlacer::draw(cv::Mat3b& image) const
{
  const int pad = 7 * text_scale_, line = 19 * text_scale_;
  for (const Label& label : labels_) { // leaders under all boxes
    const cv::Rect& box = label.box;
    const cv::Rect& target = label.target;
    const cv::Point2f from(
        std::clamp(target.x + target.width * 0.5f, 1.0f * box.x, 1.0f * box.br().x),
        std::clamp(target.y + target.height * 0.5f, 1.0f * box.y, 1.0f * box.br().y));
    const cv::Point2f to(
        std::clamp(
            from.x, target.x + 0.2f * target.width, target.x + 0.8f * target.width),
        std::clamp(
            from.y, target.y + 0.2f * target.height, target.y + 0.8f * target.height));
    drawHaloLine(image, from, to, label.color, text_scale_);
  }
  for (const Label& label : labels_) {
    const cv::Rect box = label.box & cv::Rect({}, image.size());
    cv::Mat3b area = image(box);
    area = 0.18 * area + panel * 0.82;
    cv::rectangle(image,
                  cv::Rect(box.x, box.y, 4 * text_scale_, box.height),
                  label.color,
                  cv::FILLED);
    for (std::size_t i = 0; i < label.lines.size(); ++i)
      putLine(image,
              label.lines[i],
              {box.x + pad + 4 * text_scale_,
               box.y + pad / 2 + (static_cast<int>(i) + 1) * line - 5 * text_scale_},
              text_scale_);
  }
}

} // namespace hoist
