#include "cuboid_drawing.h"

#include "drawing.h"
#include "palette.h"
#include "size_text.h"

#include <algorithm>

namespace hoist {
namespace {

constexpr int min_columns = 1280;

} // namespace

int
enlargement(int frame_width)
{
  const int width = std::max(1, frame_width);
  return std::max(1, (min_columns + width - 1) / width);
}

int
textScaleOf(int picture_width)
{
  return std::max(1, picture_width / min_columns);
}

void
tintCuboids(cv::Mat3b& picture, const cv::Mat1i& owners, double ink)
{
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x)
      if (owners(y, x) >= 0) {
        const cv::Scalar color = cuboidColor(static_cast<std::size_t>(owners(y, x)));
        cv::Vec3b& pixel = picture(y, x);
        for (int c = 0; c < 3; ++c)
          pixel[c] =
              cv::saturate_cast<unsigned char>((1 - ink) * pixel[c] + ink * color[c]);
      }
}

void
drawCuboidEdges(cv::Mat3b& picture,
                const std::vector<std::vector<EdgePiece>>& edges,
                int scale,
                const std::vector<int>& thickness)
{
  for (const bool hidden : {true, false})
    for (std::size_t i = 0; i < edges.size(); ++i)
      for (const EdgePiece& piece : edges[i]) {
        if (piece.hidden != hidden)
          continue;
        if (hidden)
          drawDashedLine(picture, piece.from, piece.to, cuboidColor(i), 1, 4 * scale);
        else
          drawHaloLine(picture, piece.from, piece.to, cuboidColor(i), thickness[i]);
      }
}

std::string
numberAndSizes(const Cuboid& cuboid, std::size_t index)
{
  return "#" + std::to_string(index + 1) + "  " + sizeText(cuboid, 0) + " x " +
         sizeText(cuboid, 1) + " x " + sizeText(cuboid, 2) + " cm";
}

} // namespace hoist
