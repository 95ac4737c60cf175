#include "progress.h"

#include <fmt/format.h>

#include <cstdio>
#include <unistd.h>

namespace hoist {

Progress::Progress(std::size_t total, bool quiet)
: total_(total), quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0)
{
}

Progress::~Progress()
{
  clear();
}

void
Progress::begin(const std::string& name)
{
  ++number_;
  name_ = name;
  if (quiet_ || !terminal_)
    return;
  constexpr std::size_t width = 24;
  const std::size_t full = (number_ - 1) * width / total_;
  fmt::print(stderr,
             "\r\033[K[{}{}] {}/{}  {}",
             std::string(full, '='),
             std::string(width - full, ' '),
             number_,
             total_,
             name_);
  std::fflush(stderr);
}

void
Progress::end(const std::string& note)
{
  if (!quiet_ && !terminal_)
    fmt::print(stderr, "[{}/{}] {}: {}\n", number_, total_, name_, note);
  clear();
}

void
Progress::clear()
{
  if (!quiet_ && terminal_) {
    fmt::print(stderr, "\r\033[K");
    std::fflush(stderr);
  }
}

} // namespace hoist
