#include "simulate.h"

#include "progress.h"

#include <hoist/data/atomic_file.h>
#include <hoist/simulation/simulate.h>

#include <opencv2/core/utility.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <thread>

namespace hoist {
namespace {

namespace fs = std::filesystem;

class Runner {
public:
  explicit Runner(const SimulationRun& run)
  : run_(run), progress_(static_cast<std::size_t>(run.count), run.quiet)
  {
  }

  void
  work()
  {
    for (int i = next_++; i < run_.count && !failed_; i = next_++) {
      try {
        make(run_.first + i);
      }
      catch (...) {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (!failed_.exchange(true))
          failure_ = std::current_exception();
      }
    }
  }

  SimulationReport
  report() const
  {
    if (failure_)
      std::rethrow_exception(failure_);
    return report_;
  }

private:
  // All files of the frame, made with this seed; what cannot be read is made again.
  bool
  isThere(const fs::path& stem, int number) const
  {
    const std::vector<fs::path> files = simulation::frameFiles(stem, run_.formats);
    if (!std::all_of(files.begin(), files.end(), [](const fs::path& file) {
          return fs::exists(file);
        }))
      return false;
    try {
      return loadAnnotation(files.back()).seed ==
             simulation::frameSeed(run_.seed, number);
    }
    catch (const LoadError&) {
      return false;
    }
  }

  void
  make(int number)
  {
    const std::string name = simulation::frameName(run_.description, number);
    const fs::path stem = run_.folder / name;
    if (run_.resume && isThere(stem, number)) {
      const std::lock_guard<std::mutex> lock(mutex_);
      ++report_.kept;
      progress_.begin(name);
      progress_.end("is there");
      return;
    }
    const simulation::Frame frame = simulation::simulate(
        simulation::makeScene(run_.description, run_.seed, number));
    const std::uint64_t bytes = writeFrame(frame, stem, run_.formats);
    const std::lock_guard<std::mutex> lock(mutex_);
    ++report_.frames;
    report_.bytes += bytes;
    progress_.begin(name);
    progress_.end(std::to_string(frame.truth.objects.size()) + " things");
  }

  const SimulationRun& run_;
  Progress progress_;
  SimulationReport report_;
  std::atomic<int> next_{0};
  std::atomic<bool> failed_{false};
  std::exception_ptr failure_;
  std::mutex mutex_;
};

// The elements as planned of every site that the frames show.
void
writePlans(const SimulationRun& run)
{
  const int per_site = run.description.visits * run.description.frames_per_visit;
  if (per_site == 0)
    return;
  fs::create_directories(run.folder / "planned");
  for (int site = run.first / per_site; site <= (run.first + run.count - 1) / per_site;
       ++site)
    writeFileAtomically(
        run.folder / "planned" /
            (run.description.name + "-" + std::to_string(site) + ".json"),
        simulation::plannedSite(run.description, run.seed, site * per_site));
}

} // namespace

SimulationReport
runSimulation(const SimulationRun& run)
{
  const auto start = std::chrono::steady_clock::now();
  fs::create_directories(run.folder);
  writePlans(run);
  // frames are what runs in parallel; OpenCV's threads would only get in their way
  const int opencv_threads = cv::getNumThreads();
  cv::setNumThreads(1);
  Runner runner(run);
  std::vector<std::thread> threads;
  for (int i = 1; i < std::min(run.threads, run.count); ++i)
    threads.emplace_back([&runner] { runner.work(); });
  runner.work();
  for (std::thread& thread : threads)
    thread.join();
  cv::setNumThreads(opencv_threads);
  SimulationReport report = runner.report();
  report.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

} // namespace hoist
