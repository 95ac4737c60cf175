#include "batch/stop_signal.h"

#include <csignal>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>

namespace hoist {
namespace {

// What a signal handler may touch.
volatile std::sig_atomic_t the_signal = 0;
volatile std::sig_atomic_t the_descriptor = -1;

constexpr std::array<int, 3> signals = {SIGINT, SIGTERM, SIGHUP};
std::array<struct sigaction, signals.size()> former;

extern "C" void
remember(int signal)
{
  const int error = errno;
  the_signal = signal;
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(the_descriptor, &one, sizeof one);
  errno = error;
}

} // namespace

StopSignal::StopSignal()
{
  the_signal = 0;
  the_descriptor = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  struct sigaction action {};
  action.sa_handler = remember;
  action.sa_flags = SA_RESTART;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    ::sigaction(signals[i], nullptr, &former[i]);
    if (former[i].sa_handler != SIG_IGN) // nohup stays nohup
      ::sigaction(signals[i], &action, nullptr);
  }
}

StopSignal::~StopSignal()
{
  for (std::size_t i = 0; i < signals.size(); ++i)
    ::sigaction(signals[i], &former[i], nullptr);
  ::close(the_descriptor);
}

int
StopSignal::received() const
{
  return the_signal;
}

int
StopSignal::descriptor() const
{
  return the_descriptor;
}

} // namespace hoist
