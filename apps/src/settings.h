#pragma once

#include <hoist/data/sensor_model.h>
#include <hoist/segmentation/cuboid_segmentation.h>

#include <opencv2/core.hpp>

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace hoist {

/** \brief All that `hoist recognize` can be told. */
struct RecognizeSettings {
  std::vector<std::string> files;
  std::string output; ///< folder; "" writes no files
  std::string config; ///< YAML file; "" for none
  std::string json;   ///< "-" for stdout, a file, or "" for none
  std::vector<std::string> formats = {"json", "png"};
  std::vector<cv::Point> why; ///< pixels to explain
  bool quiet = false;

  std::string mode = "full"; ///< "paper" or "full"
  cv::Rect region;           ///< empty for the whole frame
  std::string material;      ///< "" for not known
  std::string white_balance = "white-patch";

  FullModeParameters full;
  PaperModeParameters paper;
};

/** \brief Adds every option of `hoist recognize` to \a command, bound to \a settings.
 */
void addRecognizeOptions(CLI::App& command, RecognizeSettings& settings);

/** \brief Adds only those of them that change what is found in a frame. */
void addMethodOptions(CLI::App& command, RecognizeSettings& settings);

/** \brief Checks of them what no single option can.
 *  \throws UsageError */
void checkMethod(const RecognizeSettings& settings);

/** \brief Reads the YAML file if one is named and checks what no single option can.
 *  \throws UsageError */
void completeSettings(CLI::App& command, RecognizeSettings& settings);

} // namespace hoist
