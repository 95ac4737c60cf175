#include "viewer/display.h"

#include <X11/Xlib.h>

#include <cstdlib>

namespace hoist {

std::string
whyNoDisplay()
{
  const char* name = std::getenv("DISPLAY");
  if (name == nullptr || *name == '\0')
    return "there is no display (DISPLAY is not set)";
  Display* display = XOpenDisplay(nullptr);
  if (display == nullptr)
    return std::string("the display ") + name + " cannot be opened";
  int major = 0, event = 0, error = 0;
  const bool opengl = XQueryExtension(display, "GLX", &major, &event, &error) != 0;
  XCloseDisplay(display);
  return opengl ? "" : std::string("the display ") + name + " has no OpenGL (GLX)";
}

} // namespace hoist
