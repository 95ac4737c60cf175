#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace hoist {

/** \brief Takes settings of a command from a YAML file.
 *
 * The keys are the command's long options without their dashes; underscores count as
 * dashes, and a nested map prefixes its keys: "canny: {blur: 1}" is --canny-blur 1. A
 * flag takes true or false. What stands on the command line wins.
 *
 * \throws UsageError "file:line: reason" for text that is not YAML, an unknown key, a
 *         key given twice or a value that the option rejects
 */
void applyYaml(CLI::App& command, const std::string& file);

} // namespace hoist
