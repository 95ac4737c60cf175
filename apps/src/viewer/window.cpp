#include "viewer/window.h"

#include "viewer/egl_window.h"
#include "viewer/style.h"

#include <pcl/visualization/pcl_visualizer.h>

#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkImageData.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkRendererCollection.h>
#include <vtkWindowToImageFilter.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace hoist {
namespace pv = pcl::visualization;

ViewerWindow::ViewerWindow(const std::string& title, cv::Size size, Kind kind)
: style_(vtkSmartPointer<ViewerStyle>::New())
{
  // PCL looks into the arguments for a camera file of its own; there are none for it
  std::string name = "hoist_viewer";
  std::array<char*, 2> words = {name.data(), nullptr};
  int count = 1;
  if (kind == Kind::off_screen) {
    egl_ = std::make_unique<EglWindow>();
    visualizer_ =
        std::make_unique<pv::PCLVisualizer>(count,
                                            words.data(),
                                            vtkSmartPointer<vtkRenderer>::New(),
                                            egl_->window(),
                                            title,
                                            style_.Get(),
                                            false);
  }
  else
    visualizer_ = std::make_unique<pv::PCLVisualizer>(
        count, words.data(), title, style_.Get(), true);
  visualizer_->setShowFPS(false);
  visualizer_->setSize(size.width, size.height);
  addRenderers();
  setLayout(Layout::both, 0);
  if (kind == Kind::display) {
    constexpr unsigned long tick = 15; // [ms]
    visualizer_->getRenderWindow()->GetInteractor()->CreateRepeatingTimer(tick);
  }
}

ViewerWindow::~ViewerWindow()
{
  // The window holds its interactor, that its style, and PCL's style the window: a ring
  // that nobody would free.
  if (vtkRenderWindowInteractor* interactor =
          visualizer_->getRenderWindow()->GetInteractor())
    interactor->SetInteractorStyle(nullptr);
  space()->RemoveObserver(clip_observer_);
}

void
ViewerWindow::addRenderers()
{
  vtkRenderWindow* window = visualizer_->getRenderWindow();
  window->SetMultiSamples(0);
  window->SetNumberOfLayers(3);
  above_ = vtkSmartPointer<vtkRenderer>::New();
  above_->SetLayer(1);
  above_->InteractiveOff();
  above_->SetActiveCamera(space()->GetActiveCamera());
  image_ = vtkSmartPointer<vtkRenderer>::New();
  words_ = vtkSmartPointer<vtkRenderer>::New();
  words_->SetLayer(2);
  words_->InteractiveOff();
  space()->SetBackground(0.04, 0.04, 0.05);
  image_->SetBackground(0.04, 0.04, 0.05);
  for (const auto& renderer : {above_, image_, words_})
    window->AddRenderer(renderer);
  style_->setFlatRenderer(image_);

  const auto callback = vtkSmartPointer<vtkCallbackCommand>::New();
  callback->SetClientData(this);
  callback->SetCallback([](vtkObject*, unsigned long, void* self, void*) {
    static_cast<ViewerWindow*>(self)->clip();
  });
  clip_observer_ =
      space()->AddObserver(vtkCommand::ResetCameraClippingRangeEvent, callback);
}

void
ViewerWindow::setHandlers(KeyHandler keys, ClickHandler clicks)
{
  style_->setHandlers(std::move(keys), std::move(clicks));
}

vtkRenderer*
ViewerWindow::space() const
{
  return visualizer_->getRendererCollection()->GetFirstRenderer();
}

vtkRenderer*
ViewerWindow::above() const
{
  return above_;
}

vtkRenderer*
ViewerWindow::image() const
{
  return image_;
}

vtkRenderer*
ViewerWindow::words() const
{
  return words_;
}

void
ViewerWindow::setLayout(Layout layout, int column)
{
  const double end =
      1.0 - std::clamp(static_cast<double>(column) / size().width, 0., 0.5);
  const double middle =
      layout == Layout::both ? 0.5 * end : (layout == Layout::space ? 0.0 : end);
  // a renderer that is not seen keeps its part, but draws nothing
  const auto place = [](vtkRenderer* renderer, double from, double to) {
    const bool seen = from < to;
    renderer->SetDraw(seen ? 1 : 0);
    renderer->SetInteractive(seen ? 1 : 0);
    if (seen)
      renderer->SetViewport(from, 0, to, 1);
  };
  place(image_, 0, middle);
  place(space(), middle, end);
  place(above_, middle, end);
  above_->InteractiveOff();
}

void
ViewerWindow::setTitle(const std::string& title)
{
  visualizer_->setWindowName(title);
}

cv::Size
ViewerWindow::size() const
{
  const int* size = visualizer_->getRenderWindow()->GetSize();
  return {size[0], size[1]};
}

cv::Rect
ViewerWindow::spaceArea() const
{
  const cv::Size all = size();
  const double* part = space()->GetViewport();
  return {cvRound(part[0] * all.width),
          cvRound(part[1] * all.height),
          cvRound((part[2] - part[0]) * all.width),
          cvRound((part[3] - part[1]) * all.height)};
}

bool
ViewerWindow::inSpace(int x, int y) const
{
  return space()->GetDraw() != 0 && spaceArea().contains({x, y});
}

ViewCamera
ViewerWindow::camera() const
{
  ViewCamera c;
  vtkCamera* camera = space()->GetActiveCamera();
  c.clip = Eigen::Vector2d(camera->GetClippingRange());
  c.focal = Eigen::Vector3d(camera->GetFocalPoint());
  c.position = Eigen::Vector3d(camera->GetPosition());
  c.up = Eigen::Vector3d(camera->GetViewUp());
  c.angle = camera->GetViewAngle() * M_PI / 180;
  c.window = {size().width, size().height};
  const int* corner = visualizer_->getRenderWindow()->GetPosition();
  c.corner = {corner[0], corner[1]};
  return c;
}

void
ViewerWindow::setCamera(const ViewCamera& c)
{
  vtkCamera* camera = space()->GetActiveCamera();
  camera->SetPosition(c.position.x(), c.position.y(), c.position.z());
  camera->SetFocalPoint(c.focal.x(), c.focal.y(), c.focal.z());
  camera->SetViewUp(c.up.x(), c.up.y(), c.up.z());
  camera->SetViewAngle(c.angle * 180 / M_PI);
  clip();
}

void
ViewerWindow::setBounds(const Eigen::AlignedBox3d& bounds)
{
  bounds_ = bounds;
  clip();
}

void
ViewerWindow::clip()
{
  if (bounds_.isEmpty())
    return;
  const ViewCamera c = camera();
  const Eigen::Vector3d forward = (c.focal - c.position).normalized();
  double near = 1e9, far = -1e9;
  for (int i = 0; i < 8; ++i) {
    const auto corner = static_cast<Eigen::AlignedBox3d::CornerType>(i);
    const double along = (bounds_.corner(corner) - c.position).dot(forward);
    near = std::min(near, along);
    far = std::max(far, along);
  }
  const double margin = 0.05 * (far - near) + 0.01;
  far = std::max(far + margin, 0.1);
  near = std::max(near - margin, 0.002 * far);
  space()->GetActiveCamera()->SetClippingRange(near, far);
}

SightLine
ViewerWindow::sightLine(int x, int y, double reach) const
{
  const cv::Rect area = spaceArea();
  const ViewCamera c = camera();
  const Eigen::Vector3d forward = (c.focal - c.position).normalized();
  const Eigen::Vector3d right = forward.cross(c.up).normalized();
  const Eigen::Vector3d up = right.cross(forward);
  const double dx = x + 0.5 - (area.x + 0.5 * area.width);
  const double dy = y + 0.5 - (area.y + 0.5 * area.height);
  SightLine line;
  vtkCamera* camera = space()->GetActiveCamera();
  if (camera->GetParallelProjection() != 0) {
    const double metres = 2 * camera->GetParallelScale() / area.height;
    line.origin = c.position + metres * (dx * right + dy * up);
    line.way = forward;
    line.slope = metres * reach / std::max(1e-6, (c.focal - c.position).norm());
    return line;
  }
  const double pixel = 2 * std::tan(0.5 * c.angle) / area.height;
  line.origin = c.position;
  line.way = (forward + pixel * (dx * right + dy * up)).normalized();
  line.slope = pixel * reach;
  return line;
}

void
ViewerWindow::render()
{
  visualizer_->getRenderWindow()->Render();
}

void
ViewerWindow::waitUntilDrawn()
{
  visualizer_->getRenderWindow()->WaitForCompletion();
}

cv::Mat3b
ViewerWindow::capture()
{
  const auto filter = vtkSmartPointer<vtkWindowToImageFilter>::New();
  filter->SetInput(visualizer_->getRenderWindow());
  filter->SetInputBufferTypeToRGB();
  filter->ReadFrontBufferOff();
  filter->Update();
  vtkImageData* image = filter->GetOutput();
  const int* size = image->GetDimensions();
  cv::Mat3b picture(size[1], size[0]);
  for (int y = 0; y < picture.rows; ++y) {
    const auto* from = static_cast<const unsigned char*>(
        image->GetScalarPointer(0, picture.rows - 1 - y, 0));
    for (int x = 0; x < picture.cols; ++x, from += 3)
      picture(y, x) = {from[2], from[1], from[0]};
  }
  return picture;
}

void
ViewerWindow::processEvents()
{
  visualizer_->getRenderWindow()->GetInteractor()->ProcessEvents();
}

bool
ViewerWindow::closed() const
{
  return visualizer_->wasStopped();
}

} // namespace hoist
