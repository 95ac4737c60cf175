#include "yaml_settings.h"

#include "failures.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <set>

namespace hoist {
namespace {

class Applier {
public:
  Applier(CLI::App& command, std::string file)
  : command_(command), file_(std::move(file))
  {
    // remembered first: a setting from the file must not count as given
    for (const CLI::Option* option : command_.get_options())
      if (option->count() > 0)
        given_.insert(option);
  }

  void
  applyMap(const YAML::Node& map, const std::string& prefix)
  {
    for (const auto& entry : map) {
      if (!entry.first.IsScalar())
        fail(entry.first, "a key must be a word");
      std::string key = prefix + entry.first.Scalar();
      std::replace(key.begin(), key.end(), '_', '-');
      if (entry.second.IsMap())
        applyMap(entry.second, key + "-");
      else
        applyValue(key, entry.first, entry.second);
    }
  }

  [[noreturn]] void
  fail(const YAML::Mark& mark, const std::string& reason) const
  {
    std::string where = file_;
    if (!mark.is_null())
      where += ":" + std::to_string(mark.line + 1);
    throw UsageError(where + ": " + reason);
  }

  [[noreturn]] void
  fail(const YAML::Node& node, const std::string& reason) const
  {
    fail(node.Mark(), reason);
  }

private:
  // [a, b] and [[a, b], [c, d]] alike, separated by commas.
  void
  appendItems(const std::string& key, const YAML::Node& list, std::string& text) const
  {
    for (const auto& item : list)
      if (item.IsSequence())
        appendItems(key, item, text);
      else if (item.IsScalar())
        text += (text.empty() ? "" : ",") + item.Scalar();
      else
        fail(item, "'" + key + "' takes plain values");
  }

  void
  applyValue(const std::string& key, const YAML::Node& name, const YAML::Node& value)
  {
    CLI::Option* option = command_.get_option_no_throw("--" + key);
    if (option == nullptr || !option->get_configurable())
      fail(name, "unknown setting '" + key + "'");
    if (!seen_.insert(option).second)
      fail(name, "'" + key + "' is given twice");
    std::string text;
    if (value.IsScalar())
      text = value.Scalar();
    else if (value.IsSequence())
      appendItems(key, value, text);
    else
      fail(name, "'" + key + "' has no value");

    const bool flag = option->get_expected_max() == 0;
    if (flag && text != "true" && text != "false")
      fail(value, "'" + key + "' is true or false, not '" + text + "'");
    if (given_.count(option) != 0 || text == "false")
      return;
    try {
      option->add_result(text);
      option->run_callback();
    }
    catch (const CLI::Error& error) {
      fail(value, error.what());
    }
  }

  CLI::App& command_;
  std::string file_;
  std::set<const CLI::Option*> given_;
  std::set<const CLI::Option*> seen_;
};

} // namespace

void
applyYaml(CLI::App& command, const std::string& file)
{
  Applier applier(command, file);
  YAML::Node root;
  try {
    root = YAML::LoadFile(file);
  }
  catch (const YAML::BadFile&) {
    throw UsageError(file + ": cannot be read");
  }
  catch (const YAML::Exception& error) {
    applier.fail(error.mark, error.msg);
  }
  if (root.IsNull())
    return;
  if (!root.IsMap())
    applier.fail(root, "not a map of settings");
  applier.applyMap(root, "");
}

} // namespace hoist
