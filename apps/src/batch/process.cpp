#include "batch/process.h"

#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <system_error>
#include <thread>

namespace hoist {
namespace {

std::string
describe(int status)
{
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    const char* const name = ::sigabbrev_np(signal);
    return "was killed by signal " + std::to_string(signal) +
           (name != nullptr ? " (" + std::string(name) + ")" : "");
  }
  return "ended with code " + std::to_string(WEXITSTATUS(status));
}

} // namespace

WorkerProcess::WorkerProcess(const std::vector<std::string>& arguments) : reader_(-1)
{
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    throw std::system_error(errno, std::generic_category(), "no socket for a worker");

  std::vector<std::string> words = {"hoist"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words)
    argv.push_back(word.data());
  argv.push_back(nullptr);

  // A spawn, not a fork: the child shares nothing that another thread may hold locked.
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&files, 1, "/dev/null", O_WRONLY, 0);
  ::posix_spawn_file_actions_adddup2(&files, ends[1], worker_socket);
  const int failed =
      ::posix_spawn(&process_, "/proc/self/exe", &files, nullptr, argv.data(), environ);
  ::posix_spawn_file_actions_destroy(&files);
  ::close(ends[1]);
  if (failed != 0) {
    ::close(ends[0]);
    throw std::system_error(failed, std::generic_category(), "no process for a worker");
  }
  socket_ = ends[0];
  reader_ = MessageReader(socket_);
}

WorkerProcess::~WorkerProcess()
{
  (void)end();
  ::close(socket_);
}

std::string
WorkerProcess::end()
{
  if (process_ < 0)
    return "";
  int status = 0;
  pid_t ended = 0;
  // One that is dying of itself has closed its socket a moment before it can be waited
  // for, and its own reason must not be hidden by our signal.
  for (int i = 0; i < 200; ++i) {
    ended = ::waitpid(process_, &status, WNOHANG);
    char byte = 0;
    const bool gone = ::recv(socket_, &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 0;
    if (ended == process_ || !gone)
      break;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if (ended != process_) {
    ::kill(process_, SIGKILL);
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
  }
  process_ = -1;
  return describe(status);
}

} // namespace hoist
