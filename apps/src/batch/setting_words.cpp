#include "batch/setting_words.h"

#include <algorithm>

namespace hoist {
namespace {

std::string
joined(const std::vector<std::string>& values)
{
  std::string text;
  for (const std::string& value : values)
    text += (text.empty() ? "" : ",") + value;
  return text;
}

bool
isFlag(const CLI::Option& option)
{
  return option.get_expected_max() == 0;
}

} // namespace

std::vector<std::string>
settingWords(const std::vector<CLI::Option*>& options)
{
  std::vector<std::string> words;
  for (const CLI::Option* option : options)
    if (option->count() > 0) {
      std::string word = "--" + option->get_lnames().front();
      if (!isFlag(*option))
        word += "=" + joined(option->results());
      words.push_back(std::move(word));
    }
  return words;
}

std::string
settingsText(const std::vector<CLI::Option*>& options)
{
  std::vector<std::string> lines;
  for (const CLI::Option* option : options) {
    std::string value = option->get_default_str();
    if (option->count() > 0)
      value = isFlag(*option) ? "true" : joined(option->results());
    if (value.size() > 1 && value.front() == '[' && value.back() == ']')
      value = value.substr(1, value.size() - 2); // how CLI11 shows a list's default
    lines.push_back(option->get_lnames().front() + "=" + value + "\n");
  }
  std::sort(lines.begin(), lines.end());
  std::string text;
  for (const std::string& line : lines)
    text += line;
  return text;
}

} // namespace hoist
