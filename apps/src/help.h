#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace hoist {

/** \brief Help as a newcomer reads it: the name and what goes behind it on the left; on
 *  the right what it does, in lines that fit a terminal, then the range and the default
 *  in brackets. */
class HelpFormatter : public CLI::Formatter {
public:
  HelpFormatter() { column_width(column); }

  std::string make_option_opts(const CLI::Option* option) const override;
  std::string make_option_desc(const CLI::Option* option) const override;

private:
  static constexpr std::size_t column = 28;
  static constexpr std::size_t line = 92;
};

/** \brief Breaks text at spaces into lines of at most \a width characters. */
std::string wrapped(const std::string& text, std::size_t width);

} // namespace hoist
