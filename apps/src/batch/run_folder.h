#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>

namespace hoist {

/** \brief A hidden folder below the folder of results where one run writes its
 *  unfinished files: locked as long as the run lives, gone when it ends. */
class RunFolder {
public:
  /** \brief Takes away what dead runs have left, then makes its own.
   *  \throws std::system_error */
  explicit RunFolder(std::filesystem::path parent);
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  /** \brief A name in it that nobody else uses. */
  std::filesystem::path
  newName()
  {
    return folder_ / std::to_string(counter_++);
  }

  /** \brief Makes it again, should somebody have taken it away: on file systems whose
   *  locks do not reach other machines, another run may think that this one is dead.
   *  \throws std::system_error */
  void restore();

private:
  void make();
  void removeDead() const;

  std::filesystem::path parent_;
  std::filesystem::path folder_;
  int lock_ = -1;
  std::atomic<std::uint64_t> counter_{0};
};

} // namespace hoist
