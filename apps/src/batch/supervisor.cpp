#include "batch/supervisor.h"

#include "batch/worker.h"

#include <fmt/format.h>

#include <poll.h>

#include <algorithm>
#include <utility>

namespace hoist {
namespace {

constexpr std::chrono::milliseconds tick_time(250);
constexpr std::chrono::seconds start_time(60); // to load the program
constexpr int most_failed_starts = 3;

} // namespace

Supervisor::Supervisor(Plan plan, const StopSignal& stop)
: plan_(std::move(plan)), stop_(stop)
{
}

bool
Supervisor::run()
{
  work(plan_.memory.workers, plan_.memory.share);
  alone_ = true;
  if (stop_.received() == 0 && !last_.empty())
    work(1, plan_.memory.single);
  return stop_.received() == 0;
}

void
Supervisor::work(std::size_t workers, std::uint64_t memory)
{
  slots_.clear(); // ends the workers before
  slots_.resize(workers);
  memory_ = memory;
  while (stop_.received() == 0) {
    bool busy = false;
    for (Slot& slot : slots_)
      busy = feed(slot) || busy;
    if (!busy)
      break;
    wait();
    plan_.tick();
  }
  slots_.clear();
}

// Whether the slot has something to do.
bool
Supervisor::feed(Slot& slot)
{
  if (slot.job)
    return true;
  slot.job = nextJob();
  if (!slot.job)
    return false;
  if (!slot.process)
    start(slot);
  else if (slot.ready) {
    slot.deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                       std::chrono::duration<double>(plan_.timeout));
    (void)slot.process->send({slot.job->path}); // its end is seen when we listen
  }
  return true;
}

std::optional<Supervisor::Job>
Supervisor::nextJob()
{
  if (!alone_ && !exhausted_) {
    if (auto next = plan_.next())
      return Job{next->first, std::move(next->second), false};
    exhausted_ = true;
  }
  std::deque<Job>& queue = alone_ ? last_ : late_;
  if (queue.empty())
    return std::nullopt;
  Job job = std::move(queue.front());
  queue.pop_front();
  return job;
}

void
Supervisor::start(Slot& slot)
{
  std::vector<std::string> line = plan_.worker_words;
  line.push_back("--memory=" + std::to_string(memory_));
  slot.process = std::make_unique<WorkerProcess>(line);
  slot.ready = false;
  slot.deadline = Clock::now() + start_time;
}

// Until a worker speaks, a file's time is up, a signal comes or the next tick is due.
void
Supervisor::wait()
{
  std::vector<pollfd> polled = {{stop_.descriptor(), POLLIN, 0}};
  std::vector<Slot*> speakers;
  Clock::time_point until = Clock::now() + tick_time;
  for (Slot& slot : slots_)
    if (slot.process) {
      polled.push_back({slot.process->socket(), POLLIN, 0});
      speakers.push_back(&slot);
      if (slot.job)
        until = std::min(until, slot.deadline);
    }
  const auto time =
      std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
  (void)::poll(polled.data(), polled.size(), static_cast<int>(std::max<long>(time, 0)));
  for (std::size_t i = 0; i < speakers.size(); ++i) {
    Slot& slot = *speakers[i];
    // also one whose time is up: it may have answered while we waited for the disk
    if (polled[i + 1].revents != 0 || (slot.job && Clock::now() >= slot.deadline))
      listen(slot);
    if (!slot.process || !slot.job || Clock::now() < slot.deadline)
      continue;
    const bool ready = slot.ready;
    slot.process.reset();
    if (!ready)
      throw WorkerError("a worker did not start within a minute");
    const Job job = *std::exchange(slot.job, std::nullopt);
    failed(job, Cause::hang, fmt::format("took longer than {:g} s", plan_.timeout));
  }
}

void
Supervisor::listen(Slot& slot)
{
  const bool open = slot.process->read();
  while (slot.process)
    if (std::optional<Message> message = slot.process->take())
      answer(slot, std::move(*message));
    else
      break;
  if (!open && slot.process)
    bury(slot);
}

void
Supervisor::answer(Slot& slot, Message message)
{
  const std::string word = message.empty() ? "" : message.front();
  if (!slot.ready && word == words::ready) {
    failed_starts_ = 0;
    slot.ready = true;
    Job job = *std::exchange(slot.job, std::nullopt);
    (alone_ ? last_ : late_).push_front(std::move(job));
    return; // and is fed in the next round
  }
  if (!slot.job)
    return;
  const Job job = *std::exchange(slot.job, std::nullopt);
  if (word == words::done && message.size() >= 6 && message.size() % 2 == 0)
    plan_.done({job.file, {}, std::move(message)});
  else if (word == words::input && message.size() == 2)
    plan_.done({job.file, {Cause::input, message[1], ""}, {}});
  else {
    slot.process.reset();
    if (word == words::memory)
      failed(job, Cause::memory, "");
    else
      failed(job, Cause::crash, "its process sent nonsense");
  }
}

// A worker has died.
void
Supervisor::bury(Slot& slot)
{
  const std::string how = slot.process->end();
  slot.process.reset();
  if (!slot.ready) {
    if (++failed_starts_ >= most_failed_starts)
      throw WorkerError("workers cannot be started: the last one " + how);
    if (slot.job) // not the file's fault
      (alone_ ? last_ : late_).push_front(*std::exchange(slot.job, std::nullopt));
    return;
  }
  if (slot.job)
    failed(*std::exchange(slot.job, std::nullopt), Cause::crash, "its process " + how);
}

void
Supervisor::failed(const Job& job, Cause cause, const std::string& reason)
{
  if (cause == Cause::hang ? !job.second : !alone_) {
    std::deque<Job>& queue = cause == Cause::hang ? late_ : last_;
    queue.push_back({job.file, job.path, true});
    return;
  }
  Verdict verdict{cause, reason, ""};
  if (cause == Cause::hang)
    verdict.limit = fmt::format("{:g} s", plan_.timeout);
  if (cause == Cause::memory) {
    verdict.limit = plan_.memory_limit;
    verdict.reason = "needs more memory than the limit of " + plan_.memory_limit;
  }
  plan_.done({job.file, verdict, {}});
}

} // namespace hoist
