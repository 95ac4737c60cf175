#pragma once

#include <stdexcept>

namespace hoist {

/** \brief How the program ends. */
enum ExitCode {
  exit_ok = 0,          ///< also where nothing was found
  exit_input = 1,       ///< a file cannot be read or written
  exit_usage = 2,       ///< unknown option, bad value, missing file
  exit_quarantined = 3, ///< a batch is done, but some files make no result
  exit_retry = 75       ///< a batch is not done: run it again
};

/** \brief The caller asked for something that cannot be: exit_usage. */
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/** \brief A file cannot be read or written: exit_input. */
struct FileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

} // namespace hoist
