#pragma once

#include "viewer/camera_file.h"
#include "viewer/handlers.h"
#include "viewer/pick.h"

#include <vtkSmartPointer.h>

#include <Eigen/Geometry>

#include <opencv2/core.hpp>

#include <memory>
#include <string>

class vtkRenderer;

namespace pcl {
namespace visualization {
class PCLVisualizer;
}
} // namespace pcl

namespace hoist {

class EglWindow;
class ViewerStyle;

/** \brief Which views are seen. */
enum class Layout { both, space, image };

/** \brief The window: an image on the left, space beside it, words in a column on the
 *  right and over all. On the display, or off the screen without one. */
class ViewerWindow {
public:
  enum class Kind { display, off_screen };

  ViewerWindow(const std::string& title, cv::Size size, Kind kind);
  ~ViewerWindow();
  ViewerWindow(const ViewerWindow&) = delete;
  ViewerWindow& operator=(const ViewerWindow&) = delete;

  pcl::visualization::PCLVisualizer&
  visualizer()
  {
    return *visualizer_;
  }

  void setHandlers(KeyHandler keys, ClickHandler clicks);

  vtkRenderer* space() const; ///< with the cloud
  vtkRenderer* above() const; ///< the same view, drawn over it
  vtkRenderer* image() const;
  vtkRenderer* words() const; ///< over the whole window

  /** \param column width of the column of words [px] */
  void setLayout(Layout layout, int column);

  void setTitle(const std::string& title);

  cv::Size size() const;
  cv::Rect spaceArea() const; ///< of the view in space [px], y up
  bool inSpace(int x, int y) const;

  ViewCamera camera() const;
  void setCamera(const ViewCamera& camera);

  /** \brief Nothing within these corners is cut off by the camera. */
  void setBounds(const Eigen::AlignedBox3d& bounds);

  /** \brief The line of sight of a place of the window, in the space that is shown;
   *  things within \a reach pixels of it are met. */
  SightLine sightLine(int x, int y, double reach) const;

  void render();

  /** \brief Until all that was asked of the graphics is on the screen. */
  void waitUntilDrawn();

  /** \brief What the window shows. */
  cv::Mat3b capture();

  /** \brief Handles what the user has done, and waits a little if it was nothing. */
  void processEvents();

  /** \brief The user has ended it. */
  bool closed() const;

private:
  void addRenderers();
  void clip();

  std::unique_ptr<EglWindow> egl_; ///< first: it outlives what draws into it
  vtkSmartPointer<ViewerStyle> style_;
  std::unique_ptr<pcl::visualization::PCLVisualizer> visualizer_;
  vtkSmartPointer<vtkRenderer> above_, image_, words_;
  Eigen::AlignedBox3d bounds_;
  unsigned long clip_observer_ = 0;
};

} // namespace hoist
