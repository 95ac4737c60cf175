#include "yaml_reader.h"

#include <charconv>
#include <cmath>
#include <set>

namespace hoist {
namespace simulation {
namespace {

// Shortened, so that a message stays a line.
std::string
shown(const YAML::Node& node)
{
  if (node.IsScalar())
    return "'" + node.Scalar().substr(0, 40) + "'";
  if (node.IsSequence())
    return "a list of " + std::to_string(node.size());
  return node.IsMap() ? "a map" : "nothing";
}

std::string
numberText(double value)
{
  char text[32];
  const int length = std::snprintf(text, sizeof text, "%g", value);
  return {text, static_cast<std::size_t>(length)};
}

} // namespace

void
YamlReader::fail(const YAML::Mark& mark, const std::string& reason) const
{
  throw LoadError(file_, mark.is_null() ? "" : std::to_string(mark.line + 1), reason);
}

void
YamlReader::fail(const YAML::Node& node, const std::string& reason) const
{
  fail(node.Mark(), reason);
}

void
YamlReader::readMap(const YAML::Node& map,
                    const std::string& what,
                    const std::map<std::string, Setter>& setters) const
{
  if (!map.IsMap())
    fail(map, what + " must be a map of settings, not " + shown(map));
  std::set<std::string> seen;
  for (const auto& entry : map) {
    const std::string key = word(entry.first);
    const auto setter = setters.find(key);
    if (setter == setters.end())
      fail(entry.first, "unknown setting '" + key + "' of " + what);
    if (!seen.insert(key).second)
      fail(entry.first, "'" + key + "' is given twice");
    setter->second(entry.second);
  }
}

double
YamlReader::number(const YAML::Node& node, double low, double high) const
{
  double value = 0;
  bool good = node.IsScalar();
  if (good) {
    const std::string& text = node.Scalar();
    const char* end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, value);
    good = result.ec == std::errc() && result.ptr == end && std::isfinite(value);
  }
  if (!good)
    fail(node, "expected a number, found " + shown(node));
  if (value < low || value > high)
    fail(node,
         shown(node) + " is not between " + numberText(low) + " and " +
             numberText(high));
  return value;
}

int
YamlReader::integer(const YAML::Node& node, int low, int high) const
{
  const double value = number(node, low, high);
  if (value != std::floor(value))
    fail(node, "expected a whole number, found " + shown(node));
  return static_cast<int>(value);
}

bool
YamlReader::flag(const YAML::Node& node) const
{
  if (node.IsScalar() && node.Scalar() == "true")
    return true;
  if (!node.IsScalar() || node.Scalar() != "false")
    fail(node, "expected true or false, found " + shown(node));
  return false;
}

std::string
YamlReader::word(const YAML::Node& node) const
{
  if (!node.IsScalar() || node.Scalar().empty())
    fail(node, "expected a word, found " + shown(node));
  return node.Scalar();
}

std::vector<std::string>
YamlReader::words(const YAML::Node& node) const
{
  std::vector<std::string> list;
  if (!node.IsSequence())
    return {word(node)};
  for (const auto& item : node)
    list.push_back(word(item));
  if (list.empty())
    fail(node, "the list is empty");
  return list;
}

Range
YamlReader::range(const YAML::Node& node, double low, double high) const
{
  Range range;
  if (node.IsSequence()) {
    if (node.size() != 2)
      fail(node, "expected a number or [low, high], found " + shown(node));
    range.low = number(node[0], low, high);
    range.high = number(node[1], low, high);
    if (range.low > range.high)
      fail(node, "the lower end of the range is above the upper");
  }
  else
    range.low = range.high = number(node, low, high);
  range.line = node.Mark().line + 1;
  return range;
}

std::vector<double>
YamlReader::numbers(const YAML::Node& node,
                    std::size_t count,
                    double low,
                    double high) const
{
  if (!node.IsSequence() || node.size() != count)
    fail(node, "expected " + std::to_string(count) + " numbers, found " + shown(node));
  std::vector<double> list;
  for (const auto& item : node)
    list.push_back(number(item, low, high));
  return list;
}

std::vector<Range>
YamlReader::ranges(const YAML::Node& node,
                   std::size_t count,
                   double low,
                   double high) const
{
  if (!node.IsSequence() || node.size() != count)
    fail(node,
         "expected " + std::to_string(count) + " numbers or ranges, found " +
             shown(node));
  std::vector<Range> list;
  for (const auto& item : node)
    list.push_back(range(item, low, high));
  return list;
}

Rgb
YamlReader::color(const YAML::Node& node) const
{
  if (!node.IsSequence() || node.size() != 3)
    fail(node, "expected a colour [red, green, blue], found " + shown(node));
  Rgb rgb;
  for (std::size_t i = 0; i < 3; ++i)
    rgb[i] = static_cast<unsigned char>(integer(node[i], 0, 255));
  return rgb;
}

std::vector<Rgb>
YamlReader::colors(const YAML::Node& node) const
{
  if (node.IsSequence() && node.size() > 0 && node[0].IsSequence()) {
    std::vector<Rgb> list;
    for (const auto& item : node)
      list.push_back(color(item));
    return list;
  }
  return {color(node)};
}

std::vector<Texture>
YamlReader::textures(const YAML::Node& node) const
{
  static const std::map<std::string, Texture> names = {{"plain", Texture::plain},
                                                       {"concrete", Texture::concrete},
                                                       {"wood", Texture::wood},
                                                       {"print", Texture::print},
                                                       {"rust", Texture::rust},
                                                       {"brick", Texture::brick},
                                                       {"fabric", Texture::fabric},
                                                       {"asphalt", Texture::asphalt},
                                                       {"soil", Texture::soil},
                                                       {"plaster", Texture::plaster},
                                                       {"stripes", Texture::stripes},
                                                       {"leaf", Texture::leaf}};
  std::vector<Texture> list;
  for (const std::string& name : words(node)) {
    const auto found = names.find(name);
    if (found == names.end())
      fail(node, "unknown texture '" + name + "'");
    list.push_back(found->second);
  }
  return list;
}

} // namespace simulation
} // namespace hoist
