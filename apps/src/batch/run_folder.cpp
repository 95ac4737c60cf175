#include "batch/run_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace hoist {
namespace {

namespace fs = std::filesystem;

constexpr const char* prefix = ".run-";
constexpr const char* lock_name = "lock";

std::string
hostName()
{
  std::array<char, 256> name{};
  (void)::gethostname(name.data(), name.size() - 1);
  return name.data();
}

// The descriptor of the locked file, or -1 with errno.
int
lockFile(const fs::path& file, int flags)
{
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CLOEXEC | flags, 0666);
  if (descriptor < 0)
    return -1;
  struct stat info {};
  // whoever else had it first may have removed it just now
  if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0 && ::fstat(descriptor, &info) == 0 &&
      info.st_nlink > 0)
    return descriptor;
  ::close(descriptor);
  errno = EWOULDBLOCK;
  return -1;
}

} // namespace

RunFolder::RunFolder(fs::path parent) : parent_(std::move(parent))
{
  removeDead();
  make();
}

RunFolder::~RunFolder()
{
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
  if (lock_ >= 0)
    ::close(lock_);
}

void
RunFolder::make()
{
  // the process's number is not enough: several machines may share the folder
  const std::string name = prefix + hostName() + "-" + std::to_string(::getpid()) + "-";
  for (int i = 0; i < 1000; ++i) {
    const fs::path folder = parent_ / (name + std::to_string(i));
    if (::mkdir(folder.c_str(), 0777) != 0) {
      if (errno == EEXIST)
        continue;
      throw std::system_error(errno, std::generic_category());
    }
    const int lock = lockFile(folder / lock_name, O_CREAT);
    const int error = errno;
    if (lock >= 0) {
      if (lock_ >= 0)
        ::close(lock_);
      lock_ = lock;
      folder_ = folder;
      return;
    }
    if (error != ENOENT && error != EWOULDBLOCK) { // no other run was quicker
      std::error_code ignored;
      fs::remove_all(folder, ignored);
      throw std::system_error(error, std::generic_category());
    }
  }
  throw std::system_error(EEXIST, std::generic_category());
}

void
RunFolder::restore()
{
  struct stat info {};
  if (::stat(folder_.c_str(), &info) != 0)
    make();
}

void
RunFolder::removeDead() const
{
  std::vector<fs::path> runs;
  for (const fs::directory_entry& entry : fs::directory_iterator(parent_))
    if (entry.path().filename().string().rfind(prefix, 0) == 0)
      runs.push_back(entry.path());
  for (const fs::path& run : runs) {
    const int lock = lockFile(run / lock_name, 0);
    if (lock < 0 && errno != ENOENT) // it lives
      continue;
    std::error_code ignored;
    fs::remove_all(run, ignored);
    if (lock >= 0)
      ::close(lock);
  }
}

} // namespace hoist
