#include "viewer/egl_window.h"

#include "failures.h"

#include <vtkCallbackCommand.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkVersionMacros.h>

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <vector>

#include <dlfcn.h>

// VTK up to 9.3 finds OpenGL's functions with GLEW, which as Debian builds it asks for
// an X display last of all, when everything is done, and calls its absence an error
// (GLEW_ERROR_NO_GLX_DISPLAY). The program's own function comes before the library's.
#if VTK_MAJOR_VERSION == 9 && VTK_MINOR_VERSION < 4
extern "C" __attribute__((visibility("default"))) unsigned int
glewInit()
{
  using Init = unsigned int (*)();
  constexpr unsigned int ok = 0, error = 1, no_glx_display = 4;
  const auto real = reinterpret_cast<Init>(::dlsym(RTLD_NEXT, "glewInit"));
  const unsigned int result = real == nullptr ? error : real();
  return result == no_glx_display ? ok : result;
}
#endif

namespace hoist {

struct EglWindow::Context {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLSurface surface = EGL_NO_SURFACE;
  EGLContext context = EGL_NO_CONTEXT;

  bool open(EGLDisplay candidate);
  void close();
};

bool
EglWindow::Context::open(EGLDisplay candidate)
{
  if (candidate == EGL_NO_DISPLAY || !eglInitialize(candidate, nullptr, nullptr))
    return false;
  display = candidate;
  constexpr std::array<EGLint, 13> wanted = {EGL_SURFACE_TYPE,
                                             EGL_PBUFFER_BIT,
                                             EGL_RENDERABLE_TYPE,
                                             EGL_OPENGL_BIT,
                                             EGL_RED_SIZE,
                                             8,
                                             EGL_GREEN_SIZE,
                                             8,
                                             EGL_BLUE_SIZE,
                                             8,
                                             EGL_DEPTH_SIZE,
                                             24,
                                             EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!eglChooseConfig(display, wanted.data(), &config, 1, &count) || count < 1 ||
      !eglBindAPI(EGL_OPENGL_API))
    return false;
  // VTK draws into a buffer of its own; this surface only has to be there
  constexpr std::array<EGLint, 5> size = {EGL_WIDTH, 8, EGL_HEIGHT, 8, EGL_NONE};
  surface = eglCreatePbufferSurface(display, config, size.data());
  constexpr std::array<EGLint, 7> version = {EGL_CONTEXT_MAJOR_VERSION,
                                             3,
                                             EGL_CONTEXT_MINOR_VERSION,
                                             2,
                                             EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                             EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                             EGL_NONE};
  context = eglCreateContext(display, config, EGL_NO_CONTEXT, version.data());
  return surface != EGL_NO_SURFACE && context != EGL_NO_CONTEXT &&
         eglMakeCurrent(display, surface, surface, context);
}

void
EglWindow::Context::close()
{
  if (display == EGL_NO_DISPLAY)
    return;
  eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  if (context != EGL_NO_CONTEXT)
    eglDestroyContext(display, context);
  if (surface != EGL_NO_SURFACE)
    eglDestroySurface(display, surface);
  // The display stays open for the process to end: eglTerminate() would unload Mesa's
  // driver, which leaves memory of its own behind.
  *this = Context();
}

namespace {

// Without a display: Mesa's surfaceless platform, then every device, then the default.
std::vector<EGLDisplay>
candidates()
{
  std::vector<EGLDisplay> displays;
  const auto of_platform = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
      eglGetProcAddress("eglGetPlatformDisplayEXT"));
  const auto devices = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(
      eglGetProcAddress("eglQueryDevicesEXT"));
  if (of_platform != nullptr) {
    displays.push_back(
        of_platform(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
    std::array<EGLDeviceEXT, 16> found{};
    EGLint count = 0;
    if (devices != nullptr &&
        devices(static_cast<EGLint>(found.size()), found.data(), &count))
      for (EGLint i = 0; i < count; ++i)
        displays.push_back(of_platform(EGL_PLATFORM_DEVICE_EXT, found[i], nullptr));
  }
  displays.push_back(eglGetDisplay(EGL_DEFAULT_DISPLAY));
  return displays;
}

// VTK asks whoever owns the context.
void
answer(vtkObject*, unsigned long event, void*, void* question)
{
  if (event == vtkCommand::WindowSupportsOpenGLEvent)
    *static_cast<int*>(question) = 1;
  else if (event == vtkCommand::WindowIsCurrentEvent)
    *static_cast<bool*>(question) = true; // the only context of this thread
}

// VTK counts on what it sets in windows of its own: of things at one depth, such as the
// words over everything, the later one is seen. OpenGL begins with the first one, but
// VTK's record of its state says otherwise, so that it would set nothing: first another
// value.
void
letLaterWin(vtkObject* window, unsigned long, void*, void*)
{
  constexpr unsigned int less = 0x0201, less_or_equal = 0x0203; // GL_LESS, GL_LEQUAL
  vtkOpenGLState* state = vtkOpenGLRenderWindow::SafeDownCast(window)->GetState();
  state->vtkglDepthFunc(less);
  state->vtkglDepthFunc(less_or_equal);
}

} // namespace

EglWindow::EglWindow() : context_(std::make_unique<Context>())
{
  bool open = false;
  for (EGLDisplay candidate : candidates()) {
    open = context_->open(candidate);
    if (open)
      break;
    context_->close();
  }
  if (!open)
    throw FileError("no picture without a display: EGL gives no OpenGL 3.2 context "
                    "(the packages libegl1 and libgl1-mesa-dri draw in software)");
  const auto window = vtkSmartPointer<vtkGenericOpenGLRenderWindow>::New();
  const auto callback = vtkSmartPointer<vtkCallbackCommand>::New();
  callback->SetCallback(answer);
  window->AddObserver(vtkCommand::WindowSupportsOpenGLEvent, callback);
  window->AddObserver(vtkCommand::WindowIsCurrentEvent, callback);
  window->AddObserver(vtkCommand::WindowMakeCurrentEvent, callback);
  const auto at_start = vtkSmartPointer<vtkCallbackCommand>::New();
  at_start->SetCallback(letLaterWin);
  window->AddObserver(vtkCommand::StartEvent, at_start);
  window->SetReadyForRendering(true);
  window->SetOffScreenRendering(1);
  window_ = window;
}

EglWindow::~EglWindow()
{
  if (window_)
    window_->Finalize();
  window_ = nullptr;
  context_->close();
}

vtkSmartPointer<vtkRenderWindow>
EglWindow::window() const
{
  return window_;
}

} // namespace hoist
