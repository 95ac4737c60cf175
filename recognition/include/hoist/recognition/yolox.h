#pragma once

#include <hoist/data/load_error.h>
#include <hoist/recognition/detection.h>
#include <hoist/recognition/export.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace hoist {

/** \brief Names of classes, one a line, in the order of a network's outputs; empty
 * lines at the end are left out. \throws LoadError if the file cannot be read, or has
 * no name, an empty or a double one */
HOIST_RECOGNITION_EXPORT std::vector<std::string>
loadClassNames(const std::filesystem::path& file);

/** \brief Boxes of a YOLOX head's raw output.
 *
 * Rows are the cells of the grids of stride 8, 16 and 32, row by row: (x, y) from the
 * cell's corner in strides, logarithm of width and height in strides, objectness, and
 * one number per class, the last ones in [0, 1] (Ge et al., "YOLOX: Exceeding YOLO
 * Series in 2021", 2.1).
 *
 * \param output one row per cell, 5 + classes columns
 * \param input size of the network's input [px]
 * \param score_threshold least objectness times class score, in [0, 1]
 * \param boxes [px] of the network's input
 * \param scores, classes of each box
 */
HOIST_RECOGNITION_EXPORT void decodeYolox(const cv::Mat1f& output,
                                          const cv::Size& input,
                                          double score_threshold,
                                          std::vector<cv::Rect2d>& boxes,
                                          std::vector<float>& scores,
                                          std::vector<int>& classes);

/** \brief Any single-stage detector in the format of YOLOX, run by OpenCV's DNN module.
 *
 * The model: ONNX, input 1 x 3 x H x W (BGR, 0 to 255, letterboxed at the top left with
 * 114), one output 1 x N x (5 + classes), not decoded, see decodeYolox. */
class HOIST_RECOGNITION_EXPORT YoloxNetwork {
public:
  /** \param model an ONNX file
   *  \param class_names in the order of the model's outputs
   *  \throws LoadError if the model cannot be read, its input or output are not of that
   *  form, or it tells another number of classes */
  YoloxNetwork(const std::filesystem::path& model,
               std::vector<std::string> class_names);
  ~YoloxNetwork();
  YoloxNetwork(YoloxNetwork&&) noexcept;
  YoloxNetwork& operator=(YoloxNetwork&&) noexcept;

  /** \brief Of the network's input [px]. */
  cv::Size inputSize() const;

  const std::vector<std::string>& classNames() const;

  /** \brief Things in an image, best first, Detection::indices empty.
   *  \param score_threshold least score, in [0, 1]
   *  \param overlap_threshold of two boxes of a class with a larger intersection over
   *  union, only the better one stays; in [0, 1]
   *  \throws std::invalid_argument if the image is empty or \throws LoadError if the
   *  model fails on it */
  std::vector<Detection>
  detect(const cv::Mat3b& bgr, double score_threshold, double overlap_threshold);

private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

} // namespace hoist
