#include "batch/batch_progress.h"
#include "batch/batch_settings.h"
#include "batch/hash.h"
#include "batch/merge.h"
#include "batch/record_check.h"
#include "batch/setting_words.h"
#include "batch/stop_signal.h"
#include "batch/store.h"
#include "batch/supervisor.h"
#include "commands.h"
#include "failures.h"

#include <nlohmann/json.hpp>

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <memory>
#include <system_error>

namespace hoist {
namespace {

namespace fs = std::filesystem;

// One run of the command.
class Batch {
public:
  explicit Batch(const BatchSettings& settings)
  : settings_(settings)
  , text_(settingsText(settings.result_options))
  , all_(expandInputs(settings.inputs))
  {
    if (all_.empty())
      throw UsageError("no clouds among the inputs");
    for (std::size_t i = 0; i < all_.size(); ++i)
      if (inShard(all_[i].name, settings.shard, settings.shards))
        mine_.push_back(i);
    check_.folder = settings.inputs.out;
    check_.version = HOIST_VERSION;
    check_.settings = hexOf(hashOf(text_));
    check_.memory_limit = memoryText(settings.memory);
    check_.time_limit = fmt::format("{:g} s", settings.timeout);
    check_.retry = settings.retry;
  }

  int
  run()
  {
    const StopSignal stop;
    Store store(settings_.inputs.out);
    try {
      if (!settings_.merge_only && !recognize(store, stop))
        return interrupted(stop);
      return settings_.shards > 1 ? endOfShard() : merge(store, stop);
    }
    catch (const StoreError& error) {
      fmt::print(stderr, "hoist batch: {}\n", error.what());
    }
    catch (const WorkerError& error) {
      fmt::print(stderr, "hoist batch: {}\n", error.what());
    }
    catch (const std::system_error& error) { // no more processes, no more files
      fmt::print(stderr, "hoist batch: {}\n", error.what());
    }
    fmt::print(stderr,
               "hoist batch: stopped; what is done stays, run it again to go on\n");
    return exit_retry;
  }

private:
  bool recognize(Store& store, const StopSignal& stop);
  void commit(Store& store, Outcome outcome);
  int merge(Store& store, const StopSignal& stop) const;
  int endOfShard() const;
  void printTimes(double seconds) const;

  static int
  interrupted(const StopSignal& stop)
  {
    fmt::print(stderr,
               "hoist batch: stopped by signal {}; what is done stays, run it again to "
               "go on\n",
               stop.received());
    return exit_retry;
  }

  const BatchSettings& settings_;
  std::string text_; ///< all settings
  std::vector<InputFile> all_;
  std::vector<std::size_t> mine_; ///< of this shard
  RecordCheck check_;
  std::unique_ptr<BatchProgress> progress_;

  std::size_t next_ = 0;                            ///< in mine_
  std::vector<std::pair<std::size_t, Stamp>> open_; ///< given to workers
  std::size_t skipped_ = 0, done_ = 0, quarantined_ = 0, known_bad_ = 0;
  double read_ = 0, recognize_ = 0, worker_ = 0; ///< sums [us]
};

bool
Batch::recognize(Store& store, const StopSignal& stop)
{
  const auto start = std::chrono::steady_clock::now();
  progress_ =
      std::make_unique<BatchProgress>(mine_.size(), settings_.worker.recognize.quiet);
  Supervisor::Plan plan;
  plan.memory = planMemory(settings_.memory, settings_.jobs, all_.size());
  if (plan.memory.workers < settings_.jobs && !settings_.worker.recognize.quiet)
    fmt::print(stderr,
               "hoist batch: {} instead of {} workers, for the memory of {}\n",
               plan.memory.workers,
               settings_.jobs,
               check_.memory_limit);
  plan.memory_limit = check_.memory_limit;
  plan.timeout = settings_.timeout;
  plan.worker_words = settingWords(settings_.result_options);
  plan.worker_words.insert(plan.worker_words.begin(), "batch-worker");
  plan.next = [&]() -> std::optional<std::pair<std::size_t, std::string>> {
    while (next_ < mine_.size() && stop.received() == 0) {
      const std::size_t i = mine_[next_++];
      const Stamp stamp = stampOf(all_[i].path);
      const std::optional<RecordHead> head = check_.standing(all_[i], stamp);
      if (!head) {
        open_.emplace_back(i, stamp);
        return std::make_pair(i, all_[i].path);
      }
      ++skipped_;
      known_bad_ += head->verdict.cause != Cause::none;
      progress_->skip();
      progress_->tick();
    }
    return std::nullopt;
  };
  plan.done = [&](Outcome outcome) { commit(store, std::move(outcome)); };
  plan.tick = [&] { progress_->tick(); };
  const bool all = Supervisor(std::move(plan), stop).run();
  store.flush();
  progress_->clear();
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
  printTimes(time.count());
  return all;
}

void
Batch::commit(Store& store, Outcome outcome)
{
  const InputFile& file = all_[outcome.file];
  RecordHead head;
  for (std::size_t i = 0; i < open_.size(); ++i)
    if (open_[i].first == outcome.file) {
      head.stamp = open_[i].second; // from before it was read
      open_.erase(open_.begin() + static_cast<std::ptrdiff_t>(i));
      break;
    }
  head.version = check_.version;
  head.settings = check_.settings;
  head.path = fs::path(file.path).lexically_normal().string();
  head.verdict = outcome.verdict;

  Commit commit;
  commit.stale = {".png", ".csv", ".labels.pcd", ".ply"};
  std::string result, thumbnail;
  if (outcome.verdict.cause == Cause::none) {
    Message& answer = outcome.answer;
    result = std::move(answer[1]);
    thumbnail = std::move(answer[2]);
    read_ += std::strtod(answer[3].c_str(), nullptr);
    recognize_ += std::strtod(answer[4].c_str(), nullptr);
    worker_ += std::strtod(answer[5].c_str(), nullptr);
    for (std::size_t i = 6; i + 1 < answer.size(); i += 2) {
      head.extras.push_back({answer[i], answer[i + 1].size()});
      commit.stale.erase(
          std::remove(commit.stale.begin(), commit.stale.end(), answer[i]),
          commit.stale.end());
      commit.files.push_back({extraFile(file, answer[i]), std::move(answer[i + 1])});
    }
    ++done_;
    progress_->done();
  }
  else {
    nlohmann::ordered_json json;
    json["scene"] = fs::path(file.path).stem().string();
    json["cuboids"] = nlohmann::json::array();
    result = json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
    ++quarantined_;
    progress_->quarantine(file.path, outcome.verdict.reason);
  }
  for (std::string& suffix : commit.stale)
    suffix = extraFile(file, suffix);
  commit.files.push_back({recordFile(file), makeRecord(head, result, thumbnail)});
  store.submit(std::move(commit));
}

void
Batch::printTimes(double seconds) const
{
  const std::size_t fresh = done_ + quarantined_;
  if (settings_.worker.recognize.quiet || fresh == 0)
    return;
  const double n = static_cast<double>(std::max<std::size_t>(done_, 1)) * 1000;
  fmt::print(stderr,
             "hoist batch: {} files in {:.1f} s, {:.1f}/s; a file takes {:.1f} ms to "
             "read, {:.1f} ms to recognise, {:.2f} ms to make its results\n",
             fresh,
             seconds,
             static_cast<double>(fresh) / seconds,
             read_ / n,
             recognize_ / n,
             (worker_ - read_ - recognize_) / n);
}

int
Batch::endOfShard() const
{
  const std::size_t bad = quarantined_ + known_bad_;
  fmt::print("shard {}/{}: {} files, {} of them done before, {} quarantined; when all "
             "shards are done, merge with --merge\n",
             settings_.shard,
             settings_.shards,
             mine_.size(),
             skipped_,
             bad);
  return bad > 0 ? exit_quarantined : exit_ok;
}

int
Batch::merge(Store& store, const StopSignal& stop) const
{
  const MergeCounts counts =
      mergeRecords(store, check_, all_, text_, settings_.report_rows, stop);
  if (stop.received() != 0)
    return interrupted(stop);
  if (counts.missing > 0) {
    fmt::print(stderr,
               "hoist batch: {} of {} files have no result yet, or have changed: {}{}; "
               "run it again\n",
               counts.missing,
               all_.size(),
               counts.first_missing,
               counts.missing > 1 ? " and others" : "");
    return exit_retry;
  }
  fmt::print("{} files, {} of them done before, {} quarantined; {} {}: {}\n",
             counts.files,
             settings_.merge_only ? counts.files : skipped_,
             counts.quarantined,
             counts.cuboids,
             counts.cuboids == 1 ? "cuboid" : "cuboids",
             (fs::path(settings_.inputs.out) / "report.html").string());
  return counts.quarantined > 0 ? exit_quarantined : exit_ok;
}

} // namespace

Action
addBatchCommand(CLI::App& program)
{
  CLI::App* command = program.add_subcommand(
      "batch", "Recognise many files: each by itself, with a summary, to be resumed");
  auto settings = std::make_shared<BatchSettings>();
  addBatchOptions(*command, *settings);
  return [command, settings] {
    completeBatchSettings(*command, *settings);
    return Batch(*settings).run();
  };
}

Action
addBatchWorkerCommand(CLI::App& program)
{
  CLI::App* command = program.add_subcommand("batch-worker", "A worker of batch");
  command->group(""); // not for people
  auto settings = std::make_shared<WorkerSettings>();
  addWorkerOptions(*command, *settings);
  return [settings] { return runWorker(*settings, WorkerProcess::worker_socket); };
}

} // namespace hoist
