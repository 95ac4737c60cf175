#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>

/// Skips the running test with a message where the real clouds are not at hand.
#define HOIST_SKIP_WITHOUT_REAL_DATA()                                                 \
  do {                                                                                 \
    if (!hoist::test::realData())                                                      \
      GTEST_SKIP() << "HOIST_REAL_DATA does not name the folder of real clouds";       \
  } while (false)

namespace hoist {
namespace test {

/** \brief The folder of real clouds, from the environment variable HOIST_REAL_DATA;
 *  nothing if it is unset or no folder. */
inline std::optional<std::filesystem::path>
realData()
{
  const char* value = std::getenv("HOIST_REAL_DATA");
  if (value == nullptr || *value == '\0')
    return std::nullopt;
  std::filesystem::path path(value);
  std::error_code error;
  if (!std::filesystem::is_directory(path, error))
    return std::nullopt;
  return path;
}

} // namespace test
} // namespace hoist
