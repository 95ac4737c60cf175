#include "why.h"

#include "failures.h"
#include "size_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace hoist {
namespace {

std::string
faceText(const PlanarFace* face, const Eigen::Vector3d& ray)
{
  if (face == nullptr)
    return "  on no flat face: too small, too rough or too curved there\n";
  constexpr double degrees = 180 / 3.14159265358979323846;
  const double cosine = std::min(1.0, -face->normal.dot(ray.normalized()));
  return fmt::format(
      "  on a flat face of {} pixels, tilted {:.0f} degrees from the line "
      "of sight, rough by {:.1f} times the sensor's noise\n",
      face->pixels,
      degrees * std::acos(cosine),
      face->rms);
}

std::string
verdictText(const CuboidVerdict& verdict)
{
  const Cuboid& c = verdict.cuboid;
  return fmt::format(
      "  {} x {} x {} cm, {:.2f} m away, score {:.2f}: {}\n"
      "    on its faces {:.0f} %, outline ends {:.0f} %, ends known {:.2f}\n",
      sizeText(c, 0),
      sizeText(c, 1),
      sizeText(c, 2),
      c.center.norm(),
      c.score,
      verdict.rejected.empty() ? "recognised" : "rejected, " + verdict.rejected,
      100 * verdict.flat,
      100 * verdict.outline,
      verdict.trust);
}

} // namespace

std::string
whyText(const Recognizer& recognizer, const Frame& frame, const cv::Point& pixel)
{
  const FrameImages& images = *frame.images;
  if (!cv::Rect(0, 0, images.width(), images.height()).contains(pixel))
    throw UsageError(fmt::format("the pixel --why {},{} lies outside the frame of {} x "
                                 "{} pixels",
                                 pixel.x,
                                 pixel.y,
                                 images.width(),
                                 images.height()));
  std::string text = fmt::format("pixel {},{}: ", pixel.x, pixel.y);
  const float w = images.inverse_depth(pixel);
  const Eigen::Vector3d ray = images.intrinsics.ray(pixel.x, pixel.y);
  if (w > 0)
    text += fmt::format(
        "{:.3f} m away\n{}",
        ray.norm() / w,
        faceText(recognizer.segmentation().getFaceAt(pixel.x, pixel.y), ray));
  else
    text += "nothing was measured\n";

  const std::vector<CuboidVerdict> verdicts =
      recognizer.segmentation().getVerdictsAt(pixel.x, pixel.y);
  if (verdicts.empty())
    return text +
           "  no box was thought of here: it takes two flat faces that meet at a "
           "right angle\n";
  constexpr std::size_t most = 3;
  for (std::size_t i = 0; i < std::min(most, verdicts.size()); ++i)
    text += verdictText(verdicts[i]);
  if (verdicts.size() > most)
    text += fmt::format("  and {} more\n", verdicts.size() - most);
  return text;
}

} // namespace hoist
