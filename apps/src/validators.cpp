#include "validators.h"

#include <charconv>
#include <cmath>
#include <sstream>
#include <vector>

namespace hoist {
namespace {

template <typename Number>
bool
parse(const std::string& text, Number& value)
{
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && rest == end;
}

// Locale independent, the whole text.
bool
parseNumber(const std::string& text, double& value)
{
  return parse(text, value) && std::isfinite(value);
}

std::vector<std::string>
split(const std::string& text, char separator)
{
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

std::string
shortNumber(double value)
{
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  stream << value;
  return stream.str();
}

} // namespace

CLI::Validator
numberIn(double low, double high)
{
  const std::string range = shortNumber(low) + " to " + shortNumber(high);
  return CLI::Validator(
      [=](std::string& text) {
        double value = 0;
        if (parseNumber(text, value) && value >= low && value <= high)
          return std::string();
        return "'" + text + "' is not a number from " + range;
      },
      range);
}

CLI::Validator
integerIn(long low, long high)
{
  const std::string range = std::to_string(low) + " to " + std::to_string(high);
  return CLI::Validator(
      [=](std::string& text) {
        long value = 0;
        if (parse(text, value) && value >= low && value <= high)
          return std::string();
        return "'" + text + "' is not a whole number from " + range;
      },
      range);
}

SensorModel
parseSensor(const std::string& text)
{
  const std::size_t colon = text.find(':');
  const std::string kind = text.substr(0, colon);
  std::vector<double> numbers;
  if (colon != std::string::npos)
    for (const std::string& part : split(text.substr(colon + 1), ',')) {
      double value = 0;
      if (!parseNumber(part, value) || value <= 0)
        throw CLI::ValidationError(
            "--sensor", "'" + part + "' is not a positive number in '" + text + "'");
      numbers.push_back(value);
    }
  if (kind == "kinect" && numbers.empty())
    return SensorModel::kinect();
  if (kind == "stereo" && numbers.size() == 1)
    return SensorModel::stereo(numbers[0]);
  if (kind == "stereo" && numbers.size() == 2)
    return SensorModel::stereo(numbers[0], numbers[1]);
  if (kind == "constant" && numbers.size() == 1)
    return SensorModel::constant(numbers[0]);
  throw CLI::ValidationError(
      "--sensor",
      "'" + text + "' is none of kinect, stereo:FB, stereo:FB,SIGMA, constant:SIGMA");
}

cv::Rect
parseRegion(const std::string& text)
{
  const std::vector<std::string> parts = split(text, ',');
  long n[4] = {};
  bool good = parts.size() == 4;
  for (int i = 0; good && i < 4; ++i)
    good = parse(parts[i], n[i]) && n[i] >= (i < 2 ? 0 : 1) && n[i] <= 1000000;
  if (!good)
    throw CLI::ValidationError("--roi",
                               "'" + text +
                                   "' is not u,v,w,h: column, row, width and height in "
                                   "pixels, e.g. 40,0,320,240");
  return {static_cast<int>(n[0]),
          static_cast<int>(n[1]),
          static_cast<int>(n[2]),
          static_cast<int>(n[3])};
}

std::vector<double>
parseNumbers(const std::string& option,
             const std::string& text,
             std::size_t count,
             const std::string& meaning,
             bool groups)
{
  std::vector<double> numbers;
  bool good = true;
  for (const std::string& part : split(text, ',')) {
    numbers.push_back(0);
    good = good && parseNumber(part, numbers.back());
  }
  if (!good || (groups ? numbers.size() % count != 0 : numbers.size() != count))
    throw CLI::ValidationError(option, "'" + text + "' is not " + meaning);
  return numbers;
}

cv::Point
parsePixel(const std::string& text)
{
  const std::vector<std::string> parts = split(text, ',');
  long n[2] = {};
  bool good = parts.size() == 2;
  for (int i = 0; good && i < 2; ++i)
    good = parse(parts[i], n[i]) && n[i] >= 0 && n[i] <= 1000000;
  if (!good)
    throw CLI::ValidationError(
        "--why", "'" + text + "' is not u,v: column and row of a pixel, e.g. 320,240");
  return {static_cast<int>(n[0]), static_cast<int>(n[1])};
}

} // namespace hoist
