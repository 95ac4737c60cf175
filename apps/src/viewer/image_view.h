#pragma once

#include <opencv2/core.hpp>

#include <vtkSmartPointer.h>

class vtkImageActor;
class vtkProp;
class vtkRenderer;

namespace hoist {

/** \brief A picture in a renderer of its own, as large as fits. Its x is the frame's
 *  column u, its y is the frame's height - 1 - v [px]. */
class ImageView {
public:
  explicit ImageView(vtkRenderer* renderer);
  ~ImageView();
  ImageView(const ImageView&) = delete;
  ImageView& operator=(const ImageView&) = delete;

  /** \param scale the picture's pixels per pixel of the frame */
  void setPicture(const cv::Mat3b& picture, int scale);

  /** \brief A cross at a pixel of the frame; none at (-1, -1). */
  void mark(cv::Point pixel);

  /** \brief The whole picture is seen. */
  void fit();

  /** \brief The frame's pixel at a place of the window [px from its lower left corner];
   *  (-1, -1) where there is none. */
  cv::Point pixelAt(int x, int y) const;

private:
  vtkRenderer* renderer_;
  vtkSmartPointer<vtkImageActor> actor_;
  vtkSmartPointer<vtkProp> cross_;
  cv::Size frame_;
};

} // namespace hoist
