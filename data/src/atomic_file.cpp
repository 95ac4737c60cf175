#include <hoist/data/atomic_file.h>

#include <pcl/exceptions.h>

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

namespace hoist {
namespace {

[[noreturn]] void
fail(const std::filesystem::path& path, const char* what, int error)
{
  throw pcl::IOException(path.string() + ": " + what + ": " + std::strerror(error));
}

std::filesystem::path
temporaryName(const std::filesystem::path& path)
{
  // two threads or two processes may write the same file at once
  static std::atomic<unsigned> counter{0};
  std::filesystem::path name = path;
  name += "." + std::to_string(::getpid()) + "." + std::to_string(counter++) + ".tmp";
  return name;
}

} // namespace

AtomicFile::AtomicFile(std::filesystem::path path)
: path_(std::move(path)), temporary_(temporaryName(path_))
{
  file_ = std::fopen(temporary_.c_str(), "wbx");
  if (file_ == nullptr)
    fail(path_, "cannot be written", errno);
}

AtomicFile::~AtomicFile()
{
  if (file_ == nullptr)
    return;
  std::fclose(file_);
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void
AtomicFile::write(std::string_view bytes)
{
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size())
    fail(path_, "cannot be written", errno);
}

void
AtomicFile::commit()
{
  if (std::fflush(file_) != 0 || ::fsync(::fileno(file_)) != 0)
    fail(path_, "cannot be written", errno);
  const int closed = std::fclose(file_);
  const int close_error = errno;
  file_ = nullptr;
  std::error_code error;
  if (closed == 0)
    std::filesystem::rename(temporary_, path_, error);
  if (closed != 0 || error) {
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
    fail(path_, "cannot be written", closed != 0 ? close_error : error.value());
  }
  // the new name lasts only when the folder reaches the disk too
  const std::filesystem::path folder =
      path_.has_parent_path() ? path_.parent_path() : std::filesystem::path(".");
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor >= 0) {
    (void)::fsync(descriptor); // some file systems refuse; the file is there anyway
    ::close(descriptor);
  }
}

void
writeFileAtomically(const std::filesystem::path& path, std::string_view bytes)
{
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

} // namespace hoist
