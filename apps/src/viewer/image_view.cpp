#include "viewer/image_view.h"

#include "viewer/shapes.h"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkImageActor.h>
#include <vtkImageData.h>
#include <vtkImageMapper3D.h>
#include <vtkRenderer.h>

#include <algorithm>

namespace hoist {

ImageView::ImageView(vtkRenderer* renderer)
: renderer_(renderer), actor_(vtkSmartPointer<vtkImageActor>::New())
{
  renderer_->AddViewProp(actor_);
  renderer_->GetActiveCamera()->ParallelProjectionOn();
}

ImageView::~ImageView()
{
  mark({-1, -1});
  renderer_->RemoveViewProp(actor_);
}

void
ImageView::setPicture(const cv::Mat3b& picture, int scale)
{
  const auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(picture.cols, picture.rows, 1);
  image->SetSpacing(1.0 / scale, 1.0 / scale, 1.0);
  image->SetOrigin(0.5 / scale - 0.5, 0.5 / scale - 0.5, 0.0);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  for (int y = 0; y < picture.rows; ++y) { // VTK's first row is the lowest
    auto* to = static_cast<unsigned char*>(
        image->GetScalarPointer(0, picture.rows - 1 - y, 0));
    for (int x = 0; x < picture.cols; ++x)
      for (int c = 0; c < 3; ++c)
        *to++ = picture(y, x)[2 - c];
  }
  actor_->GetMapper()->SetInputData(image);
  const cv::Size before = frame_;
  frame_ = {picture.cols / scale, picture.rows / scale};
  if (before != frame_) {
    mark({-1, -1});
    fit();
  }
}

void
ImageView::mark(cv::Point pixel)
{
  if (cross_)
    renderer_->RemoveViewProp(cross_);
  cross_ = nullptr;
  if (pixel.x < 0 || frame_.height == 0)
    return;
  const double x = pixel.x, y = frame_.height - 1 - pixel.y, z = 0.5;
  const double gap = 0.004 * frame_.width, arm = 0.02 * frame_.width;
  const vtkSmartPointer<vtkActor> lines =
      linesActor({{{x - arm, y, z}, {x - gap, y, z}},
                  {{x + gap, y, z}, {x + arm, y, z}},
                  {{x, y - arm, z}, {x, y - gap, z}},
                  {{x, y + gap, z}, {x, y + arm, z}}},
                 cv::Scalar(60, 60, 255),
                 3.0F,
                 1.0);
  cross_ = lines;
  renderer_->AddViewProp(cross_);
}

void
ImageView::fit()
{
  const int* size = renderer_->GetSize();
  const double aspect =
      static_cast<double>(std::max(1, size[0])) / std::max(1, size[1]);
  vtkCamera* camera = renderer_->GetActiveCamera();
  const double x = 0.5 * (frame_.width - 1), y = 0.5 * (frame_.height - 1);
  camera->SetFocalPoint(x, y, 0);
  camera->SetPosition(x, y, 100);
  camera->SetViewUp(0, 1, 0);
  camera->SetParallelScale(0.5 *
                           std::max<double>(frame_.height, frame_.width / aspect));
  camera->SetClippingRange(1, 200);
}

cv::Point
ImageView::pixelAt(int x, int y) const
{
  renderer_->SetDisplayPoint(x + 0.5, y + 0.5, 0); // the pixel's centre
  renderer_->DisplayToWorld();
  const double* world = renderer_->GetWorldPoint();
  if (world[3] == 0)
    return {-1, -1};
  const int u = cvRound(world[0] / world[3]);
  const int v = frame_.height - 1 - cvRound(world[1] / world[3]);
  return u >= 0 && v >= 0 && u < frame_.width && v < frame_.height ? cv::Point(u, v)
                                                                   : cv::Point(-1, -1);
}

} // namespace hoist
