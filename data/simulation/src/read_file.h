#pragma once

#include <fstream>
#include <optional>
#include <sstream>
#include <string>

namespace hoist {
namespace simulation {

/** \brief The bytes of a file; nothing if it cannot be read. */
inline std::optional<std::string>
readFile(const std::string& file)
{
  std::ifstream in(file, std::ios::binary);
  std::stringstream bytes;
  if (!in || !(bytes << in.rdbuf()))
    return std::nullopt;
  return bytes.str();
}

} // namespace simulation
} // namespace hoist
