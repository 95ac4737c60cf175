#include "batch/batch_progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <unistd.h>

namespace hoist {
namespace {

std::string
clockText(double seconds)
{
  const long s = static_cast<long>(std::min(seconds, 3.6e6)) + 1;
  return s < 3600 ? fmt::format("{}:{:02}", s / 60, s % 60)
                  : fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

} // namespace

BatchProgress::BatchProgress(std::size_t total, bool quiet)
: total_(total)
, quiet_(quiet)
, terminal_(isatty(STDERR_FILENO) != 0)
, start_(Clock::now())
, shown_(start_)
{
}

BatchProgress::~BatchProgress()
{
  clear();
}

void
BatchProgress::done()
{
  ++done_;
  if (terminal_ && !quiet_ && done_ == 1)
    show();
}

void
BatchProgress::quarantine(const std::string& path, const std::string& reason)
{
  ++quarantined_;
  if (quiet_)
    return;
  clear();
  fmt::print(stderr, "hoist batch: quarantined {}: {}\n", path, reason);
}

void
BatchProgress::tick()
{
  const Clock::time_point now = Clock::now();
  const auto pause =
      terminal_ ? std::chrono::milliseconds(200) : std::chrono::milliseconds(10000);
  if (!quiet_ && now - shown_ >= pause)
    show();
}

void
BatchProgress::show()
{
  shown_ = Clock::now();
  if (terminal_)
    fmt::print(stderr, "\r\033[K{}", state());
  else
    fmt::print(stderr, "hoist batch: {}\n", state());
  std::fflush(stderr);
}

void
BatchProgress::clear()
{
  if (quiet_ || !terminal_)
    return;
  fmt::print(stderr, "\r\033[K");
  std::fflush(stderr);
}

std::string
BatchProgress::state() const
{
  const std::size_t fresh = done_ + quarantined_;
  const std::size_t finished = fresh + skipped_;
  std::string text;
  if (terminal_) {
    constexpr std::size_t width = 24;
    const std::size_t full = finished * width / std::max<std::size_t>(total_, 1);
    text = "[" + std::string(full, '=') + std::string(width - full, ' ') + "] ";
  }
  text += fmt::format("{}/{} files", finished, total_);
  const std::chrono::duration<double> time = Clock::now() - start_;
  if (fresh > 0 && time.count() > 0) {
    const double rate = static_cast<double>(fresh) / time.count();
    text += fmt::format(", {:.1f}/s, {} left",
                        rate,
                        clockText(static_cast<double>(total_ - finished) / rate));
  }
  if (quarantined_ > 0)
    text += fmt::format(", {} quarantined", quarantined_);
  return text;
}

} // namespace hoist
