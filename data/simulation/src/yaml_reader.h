#pragma once

#include <hoist/data/load_error.h>
#include <hoist/simulation/description.h>

#include <yaml-cpp/yaml.h>

#include <functional>
#include <map>
#include <string>

namespace hoist {
namespace simulation {

/** \brief Reads values out of YAML nodes, and says file and line of what is wrong. */
class YamlReader {
public:
  explicit YamlReader(std::string file) : file_(std::move(file)) {}

  using Setter = std::function<void(const YAML::Node&)>;

  /** \brief Calls the setter of every key of a map.
   *  \param what the map is, for messages
   *  \throws LoadError for keys without a setter or given twice */
  void readMap(const YAML::Node& map,
               const std::string& what,
               const std::map<std::string, Setter>& setters) const;

  double number(const YAML::Node& node, double low, double high) const;
  int integer(const YAML::Node& node, int low, int high) const;
  bool flag(const YAML::Node& node) const;
  std::string word(const YAML::Node& node) const;

  /** \brief One word or a list of words. */
  std::vector<std::string> words(const YAML::Node& node) const;

  /** \brief A number or [low, high]. */
  Range range(const YAML::Node& node, double low, double high) const;

  /** \brief A list of \a count numbers. */
  std::vector<double>
  numbers(const YAML::Node& node, std::size_t count, double low, double high) const;

  /** \brief A list of \a count ranges. */
  std::vector<Range>
  ranges(const YAML::Node& node, std::size_t count, double low, double high) const;

  /** \brief [r, g, b] or a list of them. */
  std::vector<Rgb> colors(const YAML::Node& node) const;

  std::vector<Texture> textures(const YAML::Node& node) const;

  [[noreturn]] void fail(const YAML::Node& node, const std::string& reason) const;
  [[noreturn]] void fail(const YAML::Mark& mark, const std::string& reason) const;

private:
  Rgb color(const YAML::Node& node) const;

  std::string file_;
};

} // namespace simulation
} // namespace hoist
