#pragma once

#include "batch/memory.h"
#include "batch/process.h"
#include "batch/record.h"
#include "batch/stop_signal.h"

#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace hoist {

/** \brief Workers cannot be started at all. */
struct WorkerError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/** \brief What became of one file. */
struct Outcome {
  std::size_t file = 0;
  Verdict verdict;
  Message answer; ///< the worker's, where the verdict has no cause
};

/** \brief Gives files to worker processes and replaces those that die.
 *
 * A worker that dies, or takes longer than the time limit, or finds too little memory
 * takes only its file with it. That file gets a second chance: behind the others where
 * time ran out; else at the end, in a process that works alone and has the memory of
 * all. So the verdict does not depend on how many workers there were.
 */
class Supervisor {
public:
  struct Plan {
    MemoryPlan memory;
    std::string memory_limit;              ///< of the batch, as the user knows it
    double timeout = 0;                    ///< per file [s]
    std::vector<std::string> worker_words; ///< the worker's command line but its memory
    /// The next file's number and path; none when all have been given.
    std::function<std::optional<std::pair<std::size_t, std::string>>()> next;
    std::function<void(Outcome)> done;
    std::function<void()> tick; ///< a few times a second
  };

  Supervisor(Plan plan, const StopSignal& stop);

  /** \brief Does all files.
   *  \return false if a signal came first
   *  \throws WorkerError and whatever the plan's functions throw */
  bool run();

private:
  using Clock = std::chrono::steady_clock;

  struct Job {
    std::size_t file = 0;
    std::string path;
    bool second = false; ///< the last chance
  };

  struct Slot {
    std::unique_ptr<WorkerProcess> process;
    bool ready = false;
    std::optional<Job> job;
    Clock::time_point deadline;
  };

  void work(std::size_t workers, std::uint64_t memory);
  bool feed(Slot& slot);
  std::optional<Job> nextJob();
  void start(Slot& slot);
  void wait();
  void listen(Slot& slot);
  void answer(Slot& slot, Message message);
  void bury(Slot& slot);
  void failed(const Job& job, Cause cause, const std::string& reason);

  Plan plan_;
  const StopSignal& stop_;
  std::vector<Slot> slots_;
  std::uint64_t memory_ = 0; ///< of each worker now
  bool alone_ = false;       ///< the last chances are given
  bool exhausted_ = false;   ///< next() has no more
  std::deque<Job> late_;     ///< second chances behind the others
  std::deque<Job> last_;     ///< second chances alone
  int failed_starts_ = 0;    ///< in a row
};

} // namespace hoist
