#pragma once

#include <Eigen/Core>

#include <opencv2/core.hpp>

#include <vtkSmartPointer.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

class vtkActor;
class vtkProp;

namespace hoist {

// Things to see, of one flat colour (BGR), in the space that is shown [m].

vtkSmartPointer<vtkActor> pointsActor(const std::vector<Eigen::Vector3d>& points,
                                      const cv::Scalar& color,
                                      float size);

/// \param width [px]
vtkSmartPointer<vtkActor>
linesActor(const std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>& lines,
           const cv::Scalar& color,
           float width,
           double opacity);

vtkSmartPointer<vtkActor>
quadsActor(const std::vector<std::array<Eigen::Vector3d, 4>>& quads,
           const cv::Scalar& color,
           double opacity);

/// \param half_axes as columns [m]
vtkSmartPointer<vtkActor> ellipsoidActor(const Eigen::Vector3d& center,
                                         const Eigen::Matrix3d& half_axes,
                                         const cv::Scalar& color);

/** \brief Words that always face the viewer.
 *  \param lift so many pixels higher than their place */
vtkSmartPointer<vtkProp> labelActor(const std::string& text,
                                    const Eigen::Vector3d& at,
                                    const cv::Scalar& color,
                                    int size,
                                    int lift = 0);

} // namespace hoist
