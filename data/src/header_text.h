#pragma once

// What the readers of PCD and PLY headers share.

#include <cctype>
#include <cstddef>
#include <string>
#include <vector>

namespace hoist {
namespace detail {

/** \brief The words of a header line, the first \a limit of them. */
inline std::vector<std::string>
split(const std::string& line, std::size_t limit)
{
  std::vector<std::string> words;
  std::size_t at = 0;
  const auto space = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (words.size() < limit) {
    while (at < line.size() && space(line[at]))
      ++at;
    if (at == line.size())
      break;
    const std::size_t first = at;
    while (at < line.size() && !space(line[at]))
      ++at;
    words.push_back(line.substr(first, at - first));
  }
  return words;
}

/** \brief Text from a file as a message may quote it: short, printable, in quotes. */
inline std::string
shown(std::string text)
{
  if (text.size() > 40)
    text = text.substr(0, 40) + "...";
  for (char& c : text)
    if (std::isprint(static_cast<unsigned char>(c)) == 0)
      c = '?';
  return '"' + text + '"';
}

} // namespace detail
} // namespace hoist
