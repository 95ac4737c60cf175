#pragma once

#include <Eigen/Core>

#include <array>
#include <string>

namespace hoist {

/** \brief Where a view is seen from; the contents of pcl_viewer's .cam files. */
struct ViewCamera {
  Eigen::Vector2d clip{0.01, 100.0}; ///< near and far [m]
  Eigen::Vector3d focal{0, 0, 1};
  Eigen::Vector3d position{0, 0, 0};
  Eigen::Vector3d up{0, -1, 0};
  double angle = 0.8575;                ///< vertical field of view [rad]
  std::array<int, 2> window{1280, 720}; ///< size [px]
  std::array<int, 2> corner{0, 0};      ///< of the window on the screen [px]
};

/** \brief Reads a .cam file of pcl_viewer or of the viewer:
 *  near,far/focal/position/up/angle/width,height/left,top.
 *  \throws FileError that names the file and what is wrong */
ViewCamera readCameraFile(const std::string& file);

/** \brief The text of such a file; numbers come back bit for bit. */
std::string cameraText(const ViewCamera& camera);

} // namespace hoist
