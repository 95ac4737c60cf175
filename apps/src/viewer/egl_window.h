#pragma once

#include <vtkSmartPointer.h>

#include <memory>
#include <string>

class vtkRenderWindow;

namespace hoist {

/** \brief A render window without a display: an OpenGL context of EGL, on a graphics
 *  card where there is one, else in software.
 *
 * VTK as Debian and Ubuntu build it draws through X only, off the screen too, and
 * aborts without a display. Its "generic" window draws into whatever context is
 * current.
 */
class EglWindow {
public:
  /** \throws FileError with the reason if there is no such context */
  EglWindow();
  ~EglWindow();
  EglWindow(const EglWindow&) = delete;
  EglWindow& operator=(const EglWindow&) = delete;

  /** \brief Must not be drawn into when this object is gone. */
  vtkSmartPointer<vtkRenderWindow> window() const;

private:
  struct Context;
  std::unique_ptr<Context> context_;
  vtkSmartPointer<vtkRenderWindow> window_;
};

} // namespace hoist
