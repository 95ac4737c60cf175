#include <hoist/recognition/yolox.h>

#include "onnx_inputs.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <opencv2/dnn.hpp>
#include <opencv2/imgproc.hpp>

namespace hoist {
namespace {

const int strides[] = {8, 16, 32};
const double padding = 114; // grey of the letterbox, as YOLOX was trained with

int
cellCount(const cv::Size& input)
{
  int count = 0;
  for (const int stride : strides)
    count += (input.width / stride) * (input.height / stride);
  return count;
}

std::string
shapeText(const std::vector<int>& shape)
{
  std::string text;
  for (const int side : shape)
    text += (text.empty() ? "" : "x") + std::to_string(side);
  return text.empty() ? "nothing" : text;
}

// What OpenCV says, as one line.
std::string
reasonOf(const cv::Exception& error)
{
  std::string text = error.err.substr(0, 200);
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

cv::Size
declaredInput(const std::string& bytes, const std::string& file)
{
  std::vector<std::vector<int>> inputs;
  if (!onnxInputs(bytes, inputs))
    throw LoadError(file, "", "not a whole ONNX model: it ends too early or is none");
  if (inputs.size() != 1)
    throw LoadError(file,
                    "",
                    "expected a model of one input, this has " +
                        std::to_string(inputs.size()));
  const std::vector<int>& shape = inputs[0];
  const auto good = [](int side) {
    return side >= 32 && side <= 4096 && side % 32 == 0;
  };
  if (shape.size() != 4 || shape[0] != 1 || shape[1] != 3 || !good(shape[2]) ||
      !good(shape[3]))
    throw LoadError(file,
                    "",
                    "expected an input of 1x3xHxW, H and W multiples of 32, found " +
                        shapeText(shape));
  return {shape[3], shape[2]};
}

} // namespace

std::vector<std::string>
loadClassNames(const std::filesystem::path& file)
{
  std::ifstream in(file);
  std::vector<std::string> names;
  for (std::string line; std::getline(in, line);) {
    if (!line.empty() && line.back() == '\r')
      line.pop_back();
    names.push_back(line);
  }
  if (!in.is_open() || in.bad())
    throw LoadError(file.string(), "", "cannot be read");
  while (!names.empty() && names.back().empty())
    names.pop_back();
  if (names.empty())
    throw LoadError(file.string(), "", "holds no names of classes");
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string line = std::to_string(i + 1);
    if (names[i].empty())
      throw LoadError(file.string(), line, "a class without a name");
    if (std::count(names.begin(), names.begin() + static_cast<long>(i), names[i]) > 0)
      throw LoadError(file.string(), line, "'" + names[i] + "' is given twice");
  }
  return names;
}

void
decodeYolox(const cv::Mat1f& output,
            const cv::Size& input,
            double score_threshold,
            std::vector<cv::Rect2d>& boxes,
            std::vector<float>& scores,
            std::vector<int>& classes)
{
  boxes.clear();
  scores.clear();
  classes.clear();
  if (output.rows != cellCount(input) || output.cols < 6)
    throw std::invalid_argument("decodeYolox: the output does not fit the input");
  int cell = 0;
  for (const int stride : strides)
    for (int y = 0; y < input.height / stride; ++y)
      for (int x = 0; x < input.width / stride; ++x) {
        const float* row = output[cell++];
        const float* best = std::max_element(row + 5, row + output.cols);
        const float score = row[4] * *best;
        const double width = std::exp(static_cast<double>(row[2])) * stride;
        const double height = std::exp(static_cast<double>(row[3])) * stride;
        const double left = (row[0] + x) * stride - width / 2;
        const double top = (row[1] + y) * stride - height / 2;
        // not >=, so that NaN is no detection
        if (!(score >= score_threshold) || !std::isfinite(left + top + width + height))
          continue;
        boxes.emplace_back(left, top, width, height);
        scores.push_back(score);
        classes.push_back(static_cast<int>(best - row) - 5);
      }
}

struct YoloxNetwork::Parts {
  std::string file;
  std::vector<std::string> class_names;
  cv::dnn::Net net;
  cv::Size input;
  cv::Mat3b letterbox;
  cv::Mat blob;

  // Checked at every call: a shape may come out only when the network runs.
  cv::Mat1f
  run()
  {
    std::vector<cv::Mat> outputs;
    try {
      cv::dnn::blobFromImage(letterbox, blob);
      net.setInput(blob);
      net.forward(outputs, net.getUnconnectedOutLayersNames());
    }
    catch (const cv::Exception& error) {
      throw LoadError(file, "", "the model cannot be run: " + reasonOf(error));
    }
    if (outputs.size() != 1)
      throw LoadError(file,
                      "",
                      "expected a model of one output, this has " +
                          std::to_string(outputs.size()));
    const cv::Mat& out = outputs[0];
    const std::vector<int> shape(out.size.p, out.size.p + out.dims);
    const int columns = 5 + static_cast<int>(class_names.size());
    if (out.type() != CV_32F || shape.size() != 3 || shape[0] != 1 ||
        shape[1] != cellCount(input) || shape[2] < 6)
      throw LoadError(file,
                      "",
                      "expected an output of 1x" + std::to_string(cellCount(input)) +
                          "x(5 + classes), found " + shapeText(shape));
    if (shape[2] != columns)
      throw LoadError(file,
                      "",
                      "the model tells " + std::to_string(shape[2] - 5) +
                          " classes, the list has " +
                          std::to_string(class_names.size()));
    return out.reshape(1, shape[1]);
  }
};

YoloxNetwork::YoloxNetwork(const std::filesystem::path& model,
                           std::vector<std::string> class_names)
: parts_(std::make_unique<Parts>())
{
  parts_->file = model.string();
  parts_->class_names = std::move(class_names);
  // read here, for OpenCV says the same of a missing file and of a broken one
  std::ifstream in(model, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in.is_open() || text.bad() || std::filesystem::is_directory(model))
    throw LoadError(parts_->file, "", "cannot be read");
  const std::string bytes = text.str();
  if (bytes.empty())
    throw LoadError(parts_->file, "", "is empty");
  parts_->input = declaredInput(bytes, parts_->file);
  try {
    parts_->net = cv::dnn::readNetFromONNX(bytes.data(), bytes.size());
    parts_->net.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
  }
  catch (const cv::Exception& error) {
    throw LoadError(
        parts_->file, "", "not an ONNX model that OpenCV can run: " + reasonOf(error));
  }
  parts_->letterbox = cv::Mat3b(parts_->input, cv::Vec3b::all(padding));
  parts_->run();
}

YoloxNetwork::~YoloxNetwork() = default;
YoloxNetwork::YoloxNetwork(YoloxNetwork&&) noexcept = default;
YoloxNetwork& YoloxNetwork::operator=(YoloxNetwork&&) noexcept = default;

cv::Size
YoloxNetwork::inputSize() const
{
  return parts_->input;
}

const std::vector<std::string>&
YoloxNetwork::classNames() const
{
  return parts_->class_names;
}

std::vector<Detection>
YoloxNetwork::detect(const cv::Mat3b& bgr,
                     double score_threshold,
                     double overlap_threshold)
{
  if (bgr.empty())
    throw std::invalid_argument("YoloxNetwork: no image");
  Parts& p = *parts_;
  const double scale = std::min(static_cast<double>(p.input.width) / bgr.cols,
                                static_cast<double>(p.input.height) / bgr.rows);
  const cv::Rect filled(0,
                        0,
                        std::max(1, static_cast<int>(bgr.cols * scale)),
                        std::max(1, static_cast<int>(bgr.rows * scale)));
  p.letterbox.setTo(cv::Scalar::all(padding));
  cv::Mat inside = p.letterbox(filled);
  cv::resize(bgr, inside, filled.size(), 0, 0, cv::INTER_LINEAR);

  std::vector<cv::Rect2d> boxes;
  std::vector<float> scores;
  std::vector<int> classes;
  decodeYolox(p.run(), p.input, score_threshold, boxes, scores, classes);

  std::vector<std::size_t> order(boxes.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return scores[a] > scores[b];
  });
  const cv::Rect2d image(0, 0, bgr.cols, bgr.rows);
  std::vector<std::size_t> kept;
  std::vector<Detection> found;
  for (const std::size_t i : order) {
    const bool doubled = std::any_of(kept.begin(), kept.end(), [&](std::size_t k) {
      const double common = (boxes[i] & boxes[k]).area();
      return classes[i] == classes[k] &&
             common > overlap_threshold * (boxes[i].area() + boxes[k].area() - common);
    });
    if (doubled)
      continue;
    kept.push_back(i);
    const cv::Rect2d box(boxes[i].x / scale,
                         boxes[i].y / scale,
                         boxes[i].width / scale,
                         boxes[i].height / scale);
    Detection detection;
    detection.object_class = p.class_names[static_cast<std::size_t>(classes[i])];
    detection.score = scores[i];
    detection.box = box & image;
    if (detection.box.area() > 0)
      found.push_back(detection);
  }
  return found;
}

} // namespace hoist
