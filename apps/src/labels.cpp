#include "labels.h"

#include "drawing.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace hoist {
namespace {

const cv::Scalar panel(32, 28, 26);

// Where a line from a point to the middle of a box meets the box.
cv::Point
edgeTowards(const cv::Rect& box, cv::Point from)
{
  return {std::clamp(from.x, box.x, box.br().x), std::clamp(from.y, box.y, box.br().y)};
}

cv::Rect
grown(const cv::Rect& box, int by)
{
  return {box.x - by, box.y - by, box.width + 2 * by, box.height + 2 * by};
}

bool
crosses(cv::Rect box, cv::Point p, cv::Point q)
{
  return cv::clipLine(box, p, q);
}

} // namespace

LabelPlacer::LabelPlacer(cv::Mat1i owners, int text_scale)
: owners_(std::move(owners)), text_scale_(text_scale)
{
  const cv::Mat1b taken = (owners_ >= 0) / 255;
  cv::integral(taken, things_above_left_, CV_32S);
}

// The pixel of the thing that is nearest to the middle of what is seen of it.
cv::Point
LabelPlacer::anchorOf(int thing) const
{
  std::vector<cv::Point> pixels;
  for (int y = 0; y < owners_.rows; y += 2)
    for (int x = 0; x < owners_.cols; x += 2)
      if (owners_(y, x) == thing)
        pixels.emplace_back(x, y);
  if (pixels.empty())
    return {owners_.cols / 2, owners_.rows / 2};
  cv::Point2d middle(0, 0);
  for (const cv::Point& p : pixels)
    middle += cv::Point2d(p);
  middle *= 1.0 / static_cast<double>(pixels.size());
  const auto distance = [&](cv::Point p) { return cv::norm(cv::Point2d(p) - middle); };
  return *std::min_element(pixels.begin(), pixels.end(), [&](cv::Point a, cv::Point b) {
    return distance(a) < distance(b);
  });
}

double
LabelPlacer::cost(const cv::Rect& box, cv::Point anchor, int thing) const
{
  const cv::Mat1i& sum = things_above_left_;
  const cv::Rect wide = grown(box, 6 * text_scale_) & cv::Rect({}, owners_.size());
  const int covered = sum(wide.y, wide.x) + sum(wide.br().y, wide.br().x) -
                      sum(wide.y, wide.br().x) - sum(wide.br().y, wide.x);
  const cv::Point end = edgeTowards(box, anchor);
  double total = cv::norm(end - anchor) / text_scale_ + 3000.0 * covered / box.area();
  for (const Label& other : labels_) {
    const cv::Rect room = grown(other.box, 8 * text_scale_);
    if ((box & room).area() > 0)
      total += 5000.0;
    if (crosses(room, end, anchor) ||
        crosses(box, other.anchor, edgeTowards(other.box, other.anchor)))
      total += 500.0;
  }
  constexpr int samples = 16;
  for (int i = 1; i < samples; ++i) { // a leader over other things misleads
    const cv::Point p = anchor + (end - anchor) * i / samples;
    const int owner =
        owners_(std::min(p.y, owners_.rows - 1), std::min(p.x, owners_.cols - 1));
    if (owner >= 0 && owner != thing)
      total += 12.0;
  }
  return total;
}

void
LabelPlacer::add(const std::vector<std::string>& lines,
                 int thing,
                 const cv::Scalar& color)
{
  const int pad = 7 * text_scale_, line = 19 * text_scale_, margin = 8 * text_scale_;
  int width = 0;
  for (const std::string& text : lines)
    width = std::max(width, textSize(text, text_scale_).width);
  const cv::Size size(
      std::min(width + 2 * pad + 4 * text_scale_, owners_.cols),
      std::min(static_cast<int>(lines.size()) * line + pad, owners_.rows));
  const cv::Point anchor = anchorOf(thing);
  const int right = std::max(0, owners_.cols - size.width - margin);
  const int bottom = std::max(0, owners_.rows - size.height - margin);
  cv::Rect best;
  double least = std::numeric_limits<double>::infinity();
  for (int y = std::min(margin, bottom); y <= bottom; y += 8 * text_scale_)
    for (int x = std::min(margin, right); x <= right; x += 8 * text_scale_) {
      const cv::Rect box({x, y}, size);
      const double c = cost(box, anchor, thing);
      if (c < least) {
        best = box;
        least = c;
      }
    }
  labels_.push_back({lines, best, anchor, color});
}

void
LabelPlacer::draw(cv::Mat3b& image) const
{
  const int pad = 7 * text_scale_, line = 19 * text_scale_;
  for (const Label& label : labels_) { // leaders under all boxes
    drawHaloLine(image,
                 edgeTowards(label.box, label.anchor),
                 label.anchor,
                 label.color,
                 text_scale_);
    cv::circle(
        image, label.anchor, 4 * text_scale_, label.color, cv::FILLED, cv::LINE_AA);
  }
  for (const Label& label : labels_) {
    const cv::Rect& box = label.box;
    cv::Mat3b area = image(box);
    area = 0.18 * area + panel * 0.82;
    cv::rectangle(image,
                  cv::Rect(box.x, box.y, 4 * text_scale_, box.height),
                  label.color,
                  cv::FILLED);
    for (std::size_t i = 0; i < label.lines.size(); ++i)
      drawText(image,
               label.lines[i],
               {box.x + pad + 4 * text_scale_,
                box.y + pad / 2 + (static_cast<int>(i) + 1) * line - 5 * text_scale_},
               text_scale_);
  }
}

} // namespace hoist
