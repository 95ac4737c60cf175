#include "commands.h"
#include "failures.h"
#include "png.h"
#include "progress.h"
#include "recognizer.h"
#include "settings.h"
#include "table.h"
#include "why.h"

#include <hoist/data/atomic_file.h>
#include <hoist/data/result_io.h>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>

namespace hoist {
namespace {

namespace fs = std::filesystem;

std::string
stemOf(const std::string& file)
{
  return fs::path(file).stem().string();
}

// One frame after the other, each reported as soon as it is done.
class Run {
public:
  explicit Run(const RecognizeSettings& settings)
  : settings_(settings)
  , recognizer_(settings)
  , progress_(settings.files.size(), settings.quiet)
  , table_(std::cout, longestStem(settings.files), !settings.material.empty())
  {
  }

  int
  run()
  {
    for (const std::string& file : settings_.files) {
      progress_.begin(file);
      try {
        runFile(file);
      }
      catch (const UsageError&) {
        progress_.clear();
        throw;
      }
      catch (const std::exception& error) { // this file's fault: go on with the rest
        progress_.clear();
        fmt::print(stderr, "hoist: {}\n", error.what());
        failed_ = true;
      }
    }
    writeJson();
    return failed_ ? exit_input : exit_ok;
  }

private:
  static std::size_t
  longestStem(const std::vector<std::string>& files)
  {
    std::size_t longest = 0;
    for (const std::string& file : files)
      longest = std::max(longest, stemOf(file).size());
    return longest;
  }

  void
  runFile(const std::string& file)
  {
    using Clock = std::chrono::steady_clock;
    const Frame frame = openFrame(file);
    const Clock::time_point start = Clock::now();
    const FrameResult result = recognizer_.recognize(frame, stemOf(file));
    const std::chrono::duration<double, std::milli> time = Clock::now() - start;
    for (const std::string& format : settings_.formats)
      if (!settings_.output.empty())
        write(format, frame, result);
    if (!settings_.json.empty())
      texts_.push_back(toJson(result));

    const std::size_t n = result.cuboids.size();
    progress_.end(
        fmt::format("{} cuboid{}, {:.0f} ms", n, n == 1 ? "" : "s", time.count()));
    for (const std::string& warning : frame.loaded.warnings)
      fmt::print(stderr, "hoist: {}: {}\n", file, warning);
    if (settings_.json != "-")
      table_.add(result);
    for (const cv::Point& pixel : settings_.why)
      std::cout << whyText(recognizer_, frame, pixel);
  }

  void
  write(const std::string& format, const Frame& frame, const FrameResult& result)
  {
    // not replace_extension: a stem may have dots of its own
    const fs::path path =
        fs::path(settings_.output) /
        (result.scene + (format == "pcd" ? "_labels" : "") + "." + format);
    if (format == "json")
      saveJson(path, result);
    else if (format == "csv")
      saveCsv(path, {result});
    else if (format == "ply")
      saveWireframePly(path, result);
    else if (format == "pcd")
      saveLabelledCloud(path, *frame.loaded.cloud, result);
    else
      savePng(path, recognizer_.overlay(frame, result));
  }

  // One file: its object. Several: an array of them.
  void
  writeJson() const
  {
    if (settings_.json.empty())
      return;
    std::string text;
    for (const std::string& one : texts_)
      text += (text.empty() ? "" : ",\n") + one;
    if (settings_.files.size() > 1)
      text = "[" + text + "]";
    if (!text.empty() && text.back() != '\n')
      text += '\n';
    if (settings_.json == "-")
      std::cout << text << std::flush;
    else if (!text.empty())
      writeFileAtomically(settings_.json, text);
  }

  const RecognizeSettings& settings_;
  Recognizer recognizer_;
  Progress progress_;
  CuboidTable table_;
  std::vector<std::string> texts_;
  bool failed_ = false;
};

int
recognizeFiles(CLI::App& command, RecognizeSettings& settings)
{
  completeSettings(command, settings);
  if (!settings.output.empty()) {
    std::error_code error;
    fs::create_directories(settings.output, error);
    if (!fs::is_directory(settings.output))
      throw FileError(settings.output + ": cannot make this folder" +
                      (error ? ": " + error.message() : ""));
  }
  return Run(settings).run();
}

} // namespace

Action
addRecognizeCommand(CLI::App& program)
{
  CLI::App* command = program.add_subcommand(
      "recognize", "Find the cuboids of frames: a table on stdout, files into DIR");
  auto settings = std::make_shared<RecognizeSettings>();
  addRecognizeOptions(*command, *settings);
  return [command, settings] { return recognizeFiles(*command, *settings); };
}

} // namespace hoist
