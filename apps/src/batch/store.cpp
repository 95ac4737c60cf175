#include "batch/store.h"

#include "failures.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace hoist {
namespace {

namespace fs = std::filesystem;

// Results that wait: enough for a slow disk, little beside the recognition's memory.
constexpr std::size_t most_bytes = std::size_t(32) << 20;
constexpr std::size_t most_files = 128; // of a group, open at once

[[noreturn]] void
fail(const fs::path& path, int error)
{
  throw StoreError(path.string() +
                   ": cannot be written: " + std::generic_category().message(error));
}

std::size_t
bytesOf(const Commit& commit)
{
  std::size_t sum = 0;
  for (const Commit::File& file : commit.files)
    sum += file.bytes.size();
  return sum;
}

int
createFile(const fs::path& path)
{
  return ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
}

// 0 or the error's number.
int
flushFolder(const fs::path& folder)
{
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0)
    return errno;
  // some file systems know no fsync of folders
  const int failed = ::fsync(descriptor) != 0 && errno != EINVAL ? errno : 0;
  ::close(descriptor);
  return failed;
}

} // namespace

Store::Store(fs::path folder) : folder_(std::move(folder))
{
  try {
    fs::create_directories(folder_ / "results");
    run_ = std::make_unique<RunFolder>(folder_);
    known_folders_.insert(folder_);
    prepareFolder(folder_ / "results");
    (void)flushFolder(fs::absolute(folder_).parent_path()); // it may be new itself
  }
  catch (const std::system_error& error) {
    throw UsageError(folder_.string() +
                     ": cannot be written: " + error.code().message());
  }
  thread_ = std::thread([this] { writeAll(); });
}

Store::~Store()
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
    waiting_.clear();
  }
  changed_.notify_all();
  thread_.join();
}

void
Store::submit(Commit commit)
{
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [&] { return failure_ || waiting_bytes_ < most_bytes; });
  if (failure_)
    std::rethrow_exception(failure_);
  waiting_bytes_ += bytesOf(commit);
  waiting_.push_back(std::move(commit));
  changed_.notify_all();
}

void
Store::flush()
{
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [&] { return failure_ || (waiting_.empty() && !busy_); });
  if (failure_)
    std::rethrow_exception(failure_);
}

void
Store::publish(const fs::path& unfinished, const std::string& name)
{
  const int descriptor = ::open(unfinished.c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor < 0)
    fail(folder_ / name, errno);
  const int failed = ::fsync(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  if (failed != 0)
    fail(folder_ / name, failed);
  rename(unfinished, name);
  flushFolders();
}

// ------------------------------------------------------------------ the thread's part

void
Store::writeAll()
{
  std::unique_lock<std::mutex> lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return ended_ || !waiting_.empty(); });
    if (ended_)
      return;
    std::vector<Commit> group;
    for (std::size_t files = 0; !waiting_.empty() && files < most_files;) {
      files += waiting_.front().files.size();
      group.push_back(std::move(waiting_.front()));
      waiting_.pop_front();
    }
    busy_ = true;
    lock.unlock();
    std::exception_ptr failure;
    try {
      writeGroup(group);
    }
    catch (const std::exception&) {
      failure = std::current_exception();
    }
    lock.lock();
    for (const Commit& commit : group)
      waiting_bytes_ -= bytesOf(commit);
    busy_ = false;
    failure_ = failure;
    changed_.notify_all();
    if (failure_)
      return;
  }
}

void
Store::writeGroup(const std::vector<Commit>& group)
{
  std::vector<Pending> files;
  for (const Commit& commit : group)
    for (const Commit::File& file : commit.files)
      files.push_back({&file, {}, -1});
  try {
    for (Pending& pending : files)
      write(pending);
    for (Pending& pending : files)
      finish(pending);
  }
  catch (...) {
    for (const Pending& pending : files)
      if (pending.descriptor >= 0)
        ::close(pending.descriptor);
    throw;
  }
  // all bytes of the group are on the disk before the first record says so
  for (const Pending& pending : files)
    rename(pending.unfinished, pending.file->name);
  for (const Commit& commit : group)
    for (const std::string& name : commit.stale)
      (void)::unlink((folder_ / name).c_str());
  flushFolders();
}

void
Store::write(Pending& pending)
{
  pending.unfinished = run_->newName();
  pending.descriptor = createFile(pending.unfinished);
  if (pending.descriptor < 0 && errno == ENOENT) {
    run_->restore();
    pending.unfinished = run_->newName();
    pending.descriptor = createFile(pending.unfinished);
  }
  const fs::path name = folder_ / pending.file->name;
  if (pending.descriptor < 0)
    fail(name, errno);
  const std::string& bytes = pending.file->bytes;
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n =
        ::write(pending.descriptor, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno != EINTR)
      fail(name, errno);
    done += n > 0 ? static_cast<std::size_t>(n) : 0;
  }
  // The disk begins at once with all of the group; the first fsync then finds most of
  // the work done. Only a hint: failures show there.
  (void)::sync_file_range(pending.descriptor, 0, 0, SYNC_FILE_RANGE_WRITE);
}

void
Store::finish(Pending& pending)
{
  const int failed = ::fsync(pending.descriptor) == 0 ? 0 : errno;
  const int closed = ::close(pending.descriptor) == 0 ? 0 : errno;
  pending.descriptor = -1;
  if (failed != 0 || closed != 0)
    fail(folder_ / pending.file->name, failed != 0 ? failed : closed);
}

void
Store::rename(const fs::path& from, const std::string& name)
{
  const fs::path to = folder_ / name;
  prepareFolder(to.parent_path());
  changed_folders_.insert(to.parent_path());
  if (::rename(from.c_str(), to.c_str()) != 0)
    fail(to, errno);
}

// Makes a folder and remembers all whose entries must reach the disk for it to last.
void
Store::prepareFolder(const fs::path& folder)
{
  if (known_folders_.count(folder) > 0)
    return;
  if (folder != folder_ && folder.has_parent_path())
    prepareFolder(folder.parent_path());
  if (::mkdir(folder.c_str(), 0777) == 0)
    changed_folders_.insert(folder.parent_path());
  else if (errno != EEXIST)
    fail(folder, errno);
  known_folders_.insert(folder);
}

void
Store::flushFolders()
{
  for (const fs::path& folder : changed_folders_)
    if (const int failed = flushFolder(folder); failed != 0)
      fail(folder, failed);
  changed_folders_.clear();
}

} // namespace hoist
