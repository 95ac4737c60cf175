#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace hoist {

/** \brief Options as the words of a command line that sets the same, whether they were
 *  typed or came from a file. Options that were not given are left out. */
std::vector<std::string> settingWords(const std::vector<CLI::Option*>& options);

/** \brief The values of all options, defaults included, as one text: the same text, the
 *  same results. */
std::string settingsText(const std::vector<CLI::Option*>& options);

} // namespace hoist
