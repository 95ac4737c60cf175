#pragma once

#include <string>
#include <vector>

namespace hoist {

/** \brief What `hoist evaluate` compares, and by which rules. */
struct EvaluateSettings {
  std::string truth;          ///< annotations: a file or a folder
  std::string results;        ///< results: a file or a folder
  std::string of = "cuboids"; ///< "cuboids", "objects" or "all"

  /// A hit shares at least this much with the truth, in (0, 1]. The first one says what
  /// counts as found where errors, attributes and calibration are concerned.
  std::vector<double> ious = {0.5, 0.75};
  double min_score = 0;         ///< predictions below are left out
  double ignore_iou = 0.25;     ///< with a difficult thing: neither hit nor wrong
  double ignore_share = 0.5;    ///< or this share of the prediction inside of one
  double color_tolerance = 0.1; ///< of the range 0 ... 255, on every channel

  std::string json;  ///< a file, "-" for stdout, "" for none
  std::string plots; ///< a folder, "" for none
  bool list = false; ///< misses and wrong boxes of every scene
};

} // namespace hoist
