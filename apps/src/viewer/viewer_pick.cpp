// What is picked in the image or in space, and the card of it.
#include "viewer/card.h"
#include "viewer/shapes.h"
#include "viewer/viewer.h"

#include <fmt/format.h>

#include <vtkActor.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>

#include <cstdio>

namespace hoist {

void
Viewer::unpick()
{
  selected_ = -1;
  selected_rejection_ = -1;
  mark({-1, -1});
}

void
Viewer::mark(cv::Point pixel)
{
  pixel_ = pixel;
  image_.mark(pixel);
  if (marker_)
    window_.above()->RemoveViewProp(marker_);
  marker_ = nullptr;
  if (pixel.x < 0 || !scene_ || !scene_->hasFrame() ||
      !(scene_->frame->images->inverse_depth(pixel) > 0))
    return;
  const cv::Vec3f& p = scene_->frame->images->points(pixel);
  const vtkSmartPointer<vtkActor> actor =
      pointsActor({scene_->pose() * Eigen::Vector3d(p[0], p[1], p[2])},
                  cv::Scalar(60, 60, 255),
                  11.0F);
  actor->GetProperty()->SetRenderPointsAsSpheres(true);
  marker_ = actor;
  window_.above()->AddViewProp(marker_);
}

void
Viewer::pickPixel(cv::Point pixel, bool card)
{
  if (pixel.x < 0 || !scene_ || !scene_->hasFrame())
    return;
  const FrameImages& images = *scene_->frame->images;
  mark(pixel);
  const cv::Vec3f& p = images.points(pixel);
  const int index = pixel.y * images.width() + pixel.x;
  if (images.inverse_depth(pixel) > 0)
    say(fmt::format("pixel {} {}: point {}: {:.4f} {:.4f} {:.4f} m",
                    pixel.x,
                    pixel.y,
                    index,
                    p[0],
                    p[1],
                    p[2]));
  else
    say(fmt::format("pixel {} {}: nothing was measured", pixel.x, pixel.y));
  if (card && images.intrinsics.valid())
    pickBox({Eigen::Vector3d::Zero(),
             images.intrinsics.ray(pixel.x, pixel.y).normalized(),
             0});
}

void
Viewer::pickInSpace(int x, int y)
{
  if (!scene_ || !scene_->hasFrame())
    return;
  constexpr double reach = 4.0; // [px], as near as a hand aims
  SightLine line = window_.sightLine(x, y, reach);
  const Eigen::Isometry3d to_sensor = scene_->pose().inverse();
  line.origin = to_sensor * line.origin;
  line.way = to_sensor.linear() * line.way;
  const FrameImages& images = *scene_->frame->images;
  const int index = pickPoint(images, line);
  if (index >= 0)
    pickPixel({index % images.width(), index / images.width()}, false);
  pickBox(line);
}

// The cuboid that the line meets; where it meets none, the rejected box, if they are
// shown.
void
Viewer::pickBox(const SightLine& line)
{
  const int cuboid = pickCuboid(cuboidsOf(*scene_), line);
  if (cuboid >= 0 || !shown_.shows(Layer::rejected)) {
    select(cuboid);
    return;
  }
  std::vector<Cuboid> rejected;
  for (const CuboidVerdict& verdict : shownRejections(*scene_))
    rejected.push_back(verdict.cuboid);
  selectRejection(pickCuboid(rejected, line));
}

void
Viewer::select(int cuboid)
{
  selected_ = cuboid;
  selected_rejection_ = -1;
  showLayers();
  printCard();
}

void
Viewer::selectRejection(int rejection)
{
  selected_ = -1;
  selected_rejection_ = rejection;
  showLayers();
  printCard();
}

// One cuboid after the other, then the rejected boxes if they are shown, then again.
void
Viewer::selectNext()
{
  if (!scene_)
    return;
  const auto cuboids = static_cast<int>(scene_->result.cuboids.size());
  const int rejected = shown_.shows(Layer::rejected)
                           ? static_cast<int>(shownRejections(*scene_).size())
                           : 0;
  if (cuboids + rejected == 0) {
    say("there is no box to choose");
    return;
  }
  const int at = selected_rejection_ >= 0 ? cuboids + selected_rejection_ : selected_;
  const int next = (at + 1) % (cuboids + rejected);
  next < cuboids ? select(next) : selectRejection(next - cuboids);
}

void
Viewer::printCard() const
{
  for (const std::string& line : cardLines())
    fmt::print("{}\n", line);
  std::fflush(stdout);
}

std::vector<std::string>
Viewer::cardLines() const
{
  if (scene_ && selected_ >= 0)
    return cardText(*scene_, static_cast<std::size_t>(selected_));
  if (scene_ && selected_rejection_ >= 0)
    return rejectionText(*scene_, static_cast<std::size_t>(selected_rejection_));
  return {};
}

} // namespace hoist
