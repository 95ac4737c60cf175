#include "batch/worker.h"

#include "batch/thumbnail.h"
#include "failures.h"
#include "png.h"
#include "recognizer.h"

#include <hoist/data/load_error.h>
#include <hoist/data/result_io.h>

#include <opencv2/core/utility.hpp>

#include <pcl/conversions.h>
#include <pcl/io/pcd_io.h>

#include <csignal>
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <new>
#include <sstream>

namespace hoist {
namespace {

using Clock = std::chrono::steady_clock;

std::string
microseconds(Clock::duration time)
{
  return std::to_string(
      std::chrono::duration_cast<std::chrono::microseconds>(time).count());
}

std::string
labelledPcd(const Frame& frame, const FrameResult& result)
{
  const auto cloud = labelledCloud(*frame.loaded.cloud, result);
  pcl::PCLPointCloud2 blob;
  pcl::toPCLPointCloud2(cloud, blob);
  std::ostringstream out;
  if (pcl::PCDWriter().writeBinaryCompressed(
          out, blob, cloud.sensor_origin_, cloud.sensor_orientation_) < 0)
    throw FileError("its labelled cloud cannot be compressed");
  return out.str();
}

class Worker {
public:
  explicit Worker(const WorkerSettings& settings)
  : settings_(settings), recognizer_(settings.recognize)
  {
  }

  Message
  answer(const std::string& path)
  {
    try {
      return recognize(path);
    }
    catch (const LoadError& error) {
      // the loader has turned bad_alloc into this
      if (error.reason() == "not enough memory for its points")
        return {words::memory, error.reason()};
      return {words::input,
              (error.position().empty() ? "" : error.position() + ": ") +
                  error.reason()};
    }
    catch (const std::bad_alloc&) {
      return {words::memory, "not enough memory"};
    }
    catch (const cv::Exception& error) {
      if (error.code == cv::Error::StsNoMem)
        return {words::memory, "not enough memory"};
      return {words::input, error.what()};
    }
    catch (const std::exception& error) {
      return {words::input, error.what()};
    }
  }

private:
  Message
  recognize(const std::string& path)
  {
    const Clock::time_point start = Clock::now();
    const Frame frame = openFrame(path);
    const Clock::time_point read = Clock::now();
    const FrameResult result =
        recognizer_.recognize(frame, std::filesystem::path(path).stem().string());
    const Clock::time_point recognized = Clock::now();

    Message message = {words::done, toJson(result)};
    message.push_back(settings_.thumbnail > 0
                          ? makeThumbnail(frame, result, settings_.thumbnail)
                          : "");
    message.resize(6);
    for (const std::string& format : settings_.recognize.formats) {
      if (format == "json")
        continue;
      message.push_back(format == "pcd" ? ".labels.pcd" : "." + format);
      if (format == "csv")
        message.push_back(toCsv(result));
      else if (format == "ply")
        message.push_back(toWireframePly(result));
      else if (format == "pcd")
        message.push_back(labelledPcd(frame, result));
      else
        message.push_back(pngBytes(recognizer_.overlay(frame, result)));
    }
    message[3] = microseconds(read - start);
    message[4] = microseconds(recognized - read);
    message[5] = microseconds(Clock::now() - start);
    return message;
  }

  const WorkerSettings& settings_;
  Recognizer recognizer_;
};

// What it asks for itself: the pages of the shared libraries are not counted.
void
limitMemory([[maybe_unused]] std::uint64_t bytes)
{
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) // shadows of TB
  const rlimit limit = {bytes, bytes};
  if (bytes > 0)
    (void)::setrlimit(RLIMIT_DATA, &limit);
#endif
}

} // namespace

int
runWorker(const WorkerSettings& settings, int socket)
{
  // The batch decides when to stop, not the terminal; and nobody outlives it.
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGTERM, SIG_IGN);
  std::signal(SIGHUP, SIG_IGN);
  (void)::prctl(PR_SET_PDEATHSIG, SIGKILL);
  (void)::fcntl(socket, F_SETFD, FD_CLOEXEC);
  const rlimit none = {0, 0};
  (void)::setrlimit(RLIMIT_CORE, &none); // a hostile folder must not fill the disk
  limitMemory(settings.memory);
  cv::setNumThreads(1); // -j says how many cores are used

  Worker worker(settings);
  if (!sendMessage(socket, {words::ready})) // also where the batch died before prctl
    return exit_ok;
  // from here on only libraries would print, into the batch's progress line
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  (void)::dup2(nowhere, STDERR_FILENO);

  MessageReader reader(socket);
  while (const std::optional<Message> job = reader.wait()) {
    if (job->size() != 1)
      return exit_usage;
    const Message answer = worker.answer(job->front());
    if (!sendMessage(socket, answer) || answer.front() == words::memory)
      return exit_ok; // memory in pieces: better a new process
  }
  return exit_ok;
}

} // namespace hoist
