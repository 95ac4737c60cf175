// hoist_viewer: clouds and what was recognised in them, in a window.
#include "batch/inputs.h"
#include "batch/stop_signal.h"
#include "failures.h"
#include "help.h"
#include "viewer/display.h"
#include "viewer/keys.h"
#include "viewer/viewer.h"

#include <pcl/console/print.h>

#include <vtkObject.h>

#include <CLI/CLI.hpp>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace {

int
failure(int code, std::string reason)
{
  for (char& c : reason)
    c = c == '\n' ? ' ' : c;
  std::fprintf(stderr,
               code == hoist::exit_usage ? "hoist_viewer: %s (hoist_viewer --help)\n"
                                         : "hoist_viewer: %s\n",
               reason.c_str());
  return code;
}

std::vector<std::string>
filesOf(const hoist::ViewerSettings& settings)
{
  hoist::InputRequest request;
  request.inputs = settings.inputs;
  std::vector<std::string> files;
  for (const hoist::InputFile& file : hoist::expandInputs(request))
    files.push_back(file.path);
  if (files.empty())
    throw hoist::UsageError("no PCD, PTS or PLY files in " + settings.inputs.front());
  return files;
}

// The allocator raises its limit for blocks of their own with every large one that is
// freed, and then keeps frames in arenas that they leave full of holes: 20 % more
// memory, which moves from file to file. A fixed limit stays.
void
giveMemoryBack()
{
#ifdef __GLIBC__
  constexpr int own_block = 1 << 17; // as the limit is at first
  mallopt(M_MMAP_THRESHOLD, own_block);
#endif
}

int
view(CLI::App& program, hoist::ViewerSettings& settings)
{
  hoist::completeViewerSettings(program, settings);
  const std::vector<std::string> files = filesOf(settings);
  hoist::LiveSettings live(program, settings.recognize);
  using Kind = hoist::ViewerWindow::Kind;
  if (!settings.screenshot.empty()) {
    hoist::Viewer viewer(files, settings, live, Kind::off_screen);
    return viewer.takeScreenshots() ? hoist::exit_ok : hoist::exit_input;
  }
  const hoist::StopSignal signal; // before the window: a signal ends it in order
  const std::string why = hoist::whyNoDisplay();
  if (!why.empty())
    throw hoist::UsageError(why + "; --screenshot FILE.png needs none");
  hoist::Viewer viewer(files, settings, live, Kind::display);
  viewer.run(signal);
  if (!viewer.stop()) {
    std::fflush(nullptr);
    std::_Exit(hoist::exit_ok); // whatever was saved is whole: saving is atomic
  }
  return hoist::exit_ok;
}

} // namespace

int
main(int argc, char** argv)
{
  giveMemoryBack();
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  vtkObject::GlobalWarningDisplayOff();

  CLI::App program("Shows organized coloured point clouds, the cuboids in them and why "
                   "others are none.\nKeys of pcl_viewer keep their meaning.");
  program.formatter(std::make_shared<hoist::HelpFormatter>());
  program.name("hoist_viewer");
  program.set_version_flag("--version", HOIST_VERSION);
  program.footer(
      "\nKeys:\n" + hoist::layerKeysText() + hoist::keysText() +
      "\nExit codes: 0 ended by q, the window's button or a signal; 1 a file "
      "cannot be read or\nwritten (with --screenshot); 2 wrong use, or no "
      "display.\nExamples: hoist_viewer scans/\n"
      "          hoist_viewer frame.pcd --screenshot frame.png");
  hoist::ViewerSettings settings;
  hoist::addViewerOptions(program, settings);
  try {
    program.parse(argc, argv);
    return view(program, settings);
  }
  catch (const CLI::Success& help) {
    return program.exit(help);
  }
  catch (const CLI::Error& error) {
    return failure(hoist::exit_usage, error.what());
  }
  catch (const hoist::UsageError& error) {
    return failure(hoist::exit_usage, error.what());
  }
  catch (const std::exception& error) {
    return failure(hoist::exit_input, error.what());
  }
}
