#pragma once

#include "batch/run_folder.h"

#include <condition_variable>
#include <deque>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace hoist {

/** \brief Results cannot be written, e.g. because the disk is full. What was written
 *  before is whole; the rest can be done by another run. */
struct StoreError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/** \brief The files of one result, in the order in which they must appear: the record
 *  comes last and says that the others are there. */
struct Commit {
  struct File {
    std::string name; ///< below the store's folder
    std::string bytes;
  };
  std::vector<File> files;
  std::vector<std::string> stale; ///< names to take away, if they are there
};

/** \brief The folder of results. A file in it is whole or not there, whatever happens.
 *
 * Everything is written under an unfinished name first, flushed to the disk, renamed,
 * and the folder of its name flushed. Many results share the waiting for the disk: a
 * thread writes all that have come in meanwhile as one group.
 */
class Store {
public:
  /** \brief Makes the folder.
   *  \throws UsageError if it cannot be made or written */
  explicit Store(std::filesystem::path folder);

  /** \brief Drops what has not been written. */
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  const std::filesystem::path&
  folder() const
  {
    return folder_;
  }

  /** \brief Hands a result to the thread; waits while much is waiting.
   *  \throws StoreError, also for an earlier result */
  void submit(Commit commit);

  /** \brief Waits until all results are on the disk.
   *  \throws StoreError */
  void flush();

  /** \brief An unfinished name, for a file that grows. */
  std::filesystem::path
  newName()
  {
    return run_->newName();
  }

  /** \brief Gives such a file its name below the folder. After flush() only.
   *  \throws StoreError */
  void publish(const std::filesystem::path& unfinished, const std::string& name);

private:
  struct Pending {
    const Commit::File* file = nullptr;
    std::filesystem::path unfinished;
    int descriptor = -1;
  };

  void prepareFolder(const std::filesystem::path& folder);
  void write(Pending& pending);
  void finish(Pending& pending);
  void rename(const std::filesystem::path& from, const std::string& name);
  void flushFolders();
  void writeGroup(const std::vector<Commit>& group);
  void writeAll();

  std::filesystem::path folder_;
  std::unique_ptr<RunFolder> run_;
  std::set<std::filesystem::path> known_folders_;
  std::set<std::filesystem::path> changed_folders_;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Commit> waiting_;
  std::size_t waiting_bytes_ = 0;
  bool busy_ = false;
  bool ended_ = false;
  std::exception_ptr failure_;
  std::thread thread_;
};

} // namespace hoist
