#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace hoist {

/** \brief Says on stderr how far a batch is, with rate and time left: a line that is
 *  rewritten on a terminal, a line every ten seconds elsewhere. Every file that is
 *  quarantined gets a line of its own. */
class BatchProgress {
public:
  BatchProgress(std::size_t total, bool quiet);
  ~BatchProgress();
  BatchProgress(const BatchProgress&) = delete;
  BatchProgress& operator=(const BatchProgress&) = delete;

  /** \brief A file whose record stands. */
  void
  skip()
  {
    ++skipped_;
  }

  /** \brief A file that was recognised; the first one is shown at once, since from
   *  then on the time left is known. */
  void done();

  void quarantine(const std::string& path, const std::string& reason);

  /** \brief Shows the state if it is time to. */
  void tick();

  /** \brief Takes the line off a terminal. */
  void clear();

private:
  using Clock = std::chrono::steady_clock;

  void show();
  std::string state() const;

  std::size_t total_;
  std::size_t skipped_ = 0;
  std::size_t done_ = 0;
  std::size_t quarantined_ = 0;
  bool quiet_;
  bool terminal_;
  Clock::time_point start_;
  Clock::time_point shown_;
};

} // namespace hoist
