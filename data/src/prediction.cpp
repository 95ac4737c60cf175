#include "json_fields.h"

#include <hoist/data/prediction.h>

namespace hoist {
namespace {

using json::Fields;
using json::Value;

// Numbers of which null says that there is none.
double
numberOrNaN(const Value& value)
{
  return value.json().is_null() ? std::numeric_limits<double>::quiet_NaN()
                                : value.numberFrom(0);
}

Eigen::Vector3d
sigmas(const Value& value)
{
  const auto entries = value.items(3, "three numbers");
  return {numberOrNaN(entries[0]), numberOrNaN(entries[1]), numberOrNaN(entries[2])};
}

std::optional<std::array<int, 3>>
colorOf(Fields& fields)
{
  for (const char* const key : {"rgb", "base_rgb"})
    if (const auto rgb = fields.get(key)) {
      const auto entries = rgb->items(3, "red, green and blue from 0 to 255");
      std::array<int, 3> out{};
      for (std::size_t i = 0; i < 3; ++i)
        out[i] = static_cast<int>(entries[i].integerIn(0, 255));
      return out;
    }
  return std::nullopt;
}

void
readAttributes(Fields& fields, Prediction& out)
{
  if (const auto rgb = colorOf(fields))
    out.rgb = rgb;
  out.material = fields.textOr("material", out.material);
  if (const auto fullness = fields.get("fullness"))
    out.fullness = fullness->boolean();
  if (const auto weight = fields.get("weight"))
    if (const double kilograms = weight->numberFrom(0); kilograms > 0)
      out.weight = kilograms; // 0 stands for "not known" in results
  if (const auto sigma = fields.get("weight_sigma"))
    out.weight_sigma = sigma->numberFrom(0);
}

Prediction
readPrediction(const Value& value, bool is_cuboid)
{
  Fields fields(value);
  Prediction out;
  out.is_cuboid = is_cuboid;
  out.center = fields.at("center").vector();
  out.size = fields.at("size").vector();
  if (out.size.minCoeff() <= 0)
    fields.at("size").failWith(
        "expected three positive numbers, found one that is not");
  out.rotation = fields.at("rotation").orthonormal();
  if (const auto score = fields.get("score"))
    out.score = score->number();
  out.object_class = fields.textOr("class");
  if (const auto sigma = fields.get("center_sigma"))
    out.center_sigma = sigmas(*sigma);
  if (const auto sigma = fields.get("size_sigma"))
    out.size_sigma = sigmas(*sigma);
  if (const auto sigma = fields.get("rotation_sigma"))
    out.rotation_sigma = sigma->numberFrom(0);
  if (const auto source = fields.get("dimension_source")) {
    const auto entries = source->items(3, "three texts");
    for (std::size_t i = 0; i < 3; ++i)
      out.dimension_source[i] = entries[i].text();
  }
  readAttributes(fields, out);
  if (const auto features = fields.get("features")) {
    Fields inner(*features);
    readAttributes(inner, out);
  }
  return out;
}

PredictedFrame
readFrame(const Value& value)
{
  Fields fields(value);
  PredictedFrame frame;
  frame.scene = fields.textOr("scene");
  bool any = false;
  for (const char* const key : {"cuboids", "objects"})
    if (const auto list = fields.get(key)) {
      any = true;
      for (const Value& entry : list->items())
        try {
          frame.predictions.push_back(
              readPrediction(entry, std::string(key) == "cuboids"));
        }
        catch (const LoadError& error) {
          frame.skipped.emplace_back(error.what());
        }
    }
  if (!any)
    value.failWith("no results: neither \"cuboids\" nor \"objects\" is in it");
  return frame;
}

} // namespace

std::vector<PredictedFrame>
predictionsFromJson(const std::string& text, const std::string& name)
{
  const json::Json parsed = json::parse(text, name);
  const Value root(parsed, "", name);
  std::vector<PredictedFrame> frames;
  if (parsed.is_array())
    for (const Value& entry : root.items())
      frames.push_back(readFrame(entry));
  else
    frames.push_back(readFrame(root));
  return frames;
}

std::vector<PredictedFrame>
loadPredictions(const std::filesystem::path& file)
{
  return predictionsFromJson(json::readText(file), file.string());
}

} // namespace hoist
