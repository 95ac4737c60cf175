#include "help.h"

#include <cctype>
#include <sstream>

namespace hoist {

std::string
wrapped(const std::string& text, std::size_t width)
{
  std::istringstream words(text);
  std::string word, out;
  std::size_t used = 0;
  while (words >> word) {
    if (used > 0 && used + 1 + word.size() > width) {
      out += '\n';
      used = 0;
    }
    if (used > 0) {
      out += ' ';
      ++used;
    }
    out += word;
    used += word.size();
  }
  return out;
}

std::string
HelpFormatter::make_option_opts(const CLI::Option* option) const
{
  // "N:0 to 5" is the name and what its validator says
  const std::string type = option->get_type_name();
  const std::string name = type.substr(0, type.find(':'));
  return name.empty() ? "" : " " + name;
}

std::string
HelpFormatter::make_option_desc(const CLI::Option* option) const
{
  std::string notes;
  const std::string type = option->get_type_name();
  const std::size_t colon = type.find(':');
  if (colon != std::string::npos && colon + 1 < type.size() &&
      std::isdigit(static_cast<unsigned char>(type[colon + 1])) != 0)
    notes = type.substr(colon + 1);
  std::string value = option->get_default_str();
  if (!value.empty()) {
    if (value.front() == '[' && value.back() == ']')
      value = value.substr(1, value.size() - 2);
    notes += (notes.empty() ? "default " : "; default ") + value;
  }
  return wrapped(option->get_description() + (notes.empty() ? "" : " [" + notes + "]"),
                 line - column);
}

} // namespace hoist
