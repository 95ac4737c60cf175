#pragma once

#include <Eigen/Core>

#include <opencv2/core.hpp>

#include <vtkSmartPointer.h>

#include <vector>

class vtkActor;
class vtkPolyData;
class vtkRenderer;

namespace hoist {

/** \brief Boxes of lines. An edge that its own box hides from the camera is dashed, as
 *  in a draughtsman's drawing; which ones these are is found again before every
 *  picture. */
class WireBoxes {
public:
  explicit WireBoxes(vtkRenderer* renderer);
  ~WireBoxes();
  WireBoxes(const WireBoxes&) = delete;
  WireBoxes& operator=(const WireBoxes&) = delete;

  /** \param corners as Cuboid::corners(), in the space that is shown
   *  \param dash length of dashes and gaps [m] */
  void add(const Eigen::Matrix<double, 3, 8>& corners,
           const cv::Scalar& color,
           float width,
           double dash);

  void clear();

private:
  struct Box {
    Eigen::Matrix<double, 3, 8> corners;
    double dash;
    vtkSmartPointer<vtkPolyData> lines;
    vtkSmartPointer<vtkActor> actor;
    int hidden = -1; ///< a bit for every edge; -1: nothing drawn yet
  };

  void look();

  vtkRenderer* renderer_;
  std::vector<Box> boxes_;
  unsigned long observer_ = 0;
};

} // namespace hoist
