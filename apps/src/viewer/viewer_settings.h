#pragma once

#include "settings.h"
#include "viewer/layers.h"
#include "viewer/scene.h"

#include <opencv2/core.hpp>

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace hoist {

/** \brief All that `hoist_viewer` can be told. */
struct ViewerSettings {
  std::vector<std::string> inputs;
  std::string output = ".";
  SceneFiles beside;
  std::vector<std::string> layers; ///< shown at the start; empty: the usual ones
  std::string camera;              ///< .cam file; "" for none
  std::string screenshot;          ///< PNG; "" opens a window
  int frames = 1;                  ///< files to make screenshots of
  cv::Size size{1600, 720};        ///< of the window [px]
  bool verbose = false;            ///< says how long steps take
  RecognizeSettings recognize;
};

/** \brief Adds every option to \a program, bound to \a settings. Those that change what
 *  is found come from \a settings.recognize.config too. */
void addViewerOptions(CLI::App& program, ViewerSettings& settings);

/** \brief Reads the YAML file if one is named and checks what no single option can.
 *  \throws UsageError */
void completeViewerSettings(CLI::App& program, ViewerSettings& settings);

/** \brief Which layers are shown at the start. */
LayerSet layersOf(const ViewerSettings& settings);

} // namespace hoist
