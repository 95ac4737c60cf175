#include "viewer/detections.h"

#include "failures.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <limits>

namespace hoist {
namespace {

using Json = nlohmann::json;

std::string
labelOf(const Json& entry)
{
  for (const char* key : {"class", "label"})
    if (entry.contains(key))
      return entry[key].is_string() ? entry[key].get<std::string>() : entry[key].dump();
  return "";
}

Detection
detectionOf(const Json& entry)
{
  Detection detection;
  const auto box = entry.at("box").get<std::vector<double>>();
  if (box.size() != 4)
    throw FileError("a box has four numbers: left, top, width, height");
  for (const double number : box)
    if (!(std::abs(number) < 1e6))
      throw FileError("a number of a box is not in pixels");
  if (box[2] <= 0 || box[3] <= 0)
    throw FileError("a box is as wide or as high as nothing");
  detection.box = {box[0], box[1], box[2], box[3]};
  detection.label = labelOf(entry);
  const auto score = entry.find("score");
  detection.score = score != entry.end() && score->is_number()
                        ? score->get<double>()
                        : std::numeric_limits<double>::quiet_NaN();
  return detection;
}

} // namespace

std::vector<Detection>
loadDetections(const std::string& file)
{
  std::ifstream in(file);
  if (!in)
    throw FileError(file + ": cannot be read");
  std::vector<Detection> detections;
  try {
    const Json json = Json::parse(in);
    for (const Json& entry : json.is_array() ? json : json.at("detections"))
      detections.push_back(detectionOf(entry));
  }
  catch (const FileError& error) {
    throw FileError(file + ": " + error.what());
  }
  catch (const Json::exception& error) {
    throw FileError(file + ": no list of detections: " + error.what());
  }
  return detections;
}

} // namespace hoist
