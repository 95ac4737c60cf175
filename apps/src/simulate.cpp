#include "simulate.h"

#include "commands.h"
#include "failures.h"
#include "validators.h"

#include <hoist/data/atomic_file.h>
#include <hoist/data/load_error.h>
#include <hoist/simulation/suites.h>

#include <fmt/format.h>

#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <thread>

namespace hoist {
namespace {

struct SimulateSettings {
  std::string scene;
  std::string suite;
  bool list = false;
  bool print = false;
  std::optional<std::uint64_t> seed;
  std::optional<int> count;
  int first = 0;
  std::string folder;
  std::vector<std::string> formats;
  int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  bool resume = false;
  bool quiet = false;
};

int
listSuites()
{
  for (const simulation::Suite& suite : simulation::suites())
    fmt::print("{:<16} {:>6} frames, seed {}, {:<8} {}\n",
               suite.name,
               suite.frames,
               suite.seed,
               suite.format + ":",
               suite.what);
  return exit_ok;
}

std::string
readText(const std::string& file)
{
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  if (!in || !(text << in.rdbuf()))
    throw FileError(file + ": cannot be read");
  return text.str();
}

std::vector<simulation::FrameFormat>
formatsOf(const std::vector<std::string>& names)
{
  std::vector<simulation::FrameFormat> formats;
  for (const std::string& name : names)
    formats.push_back(name == "pcd"   ? simulation::FrameFormat::pcd
                      : name == "pts" ? simulation::FrameFormat::pts
                                      : simulation::FrameFormat::compact);
  return formats;
}

int
simulateFrames(const SimulateSettings& settings)
{
  if (settings.list)
    return listSuites();
  if (settings.scene.empty() == settings.suite.empty())
    throw UsageError("needs either a SCENE or --suite");
  const simulation::Suite* suite =
      settings.suite.empty() ? nullptr : simulation::findSuite(settings.suite);
  if (suite == nullptr && !settings.suite.empty())
    throw UsageError("unknown suite '" + settings.suite + "': see --list-suites");
  const std::string text = suite != nullptr ? suite->yaml : readText(settings.scene);
  if (settings.print) {
    fmt::print("{}", text);
    return exit_ok;
  }
  if (settings.folder.empty())
    throw UsageError("--output is required");

  SimulationRun run;
  try {
    run.description = simulation::parseDescription(
        text, suite != nullptr ? suite->name + ".yaml" : settings.scene);
  }
  catch (const LoadError& error) { // bad values, as those of the command line
    throw UsageError(error.what());
  }
  run.seed = settings.seed.value_or(suite != nullptr ? suite->seed : 1);
  run.first = settings.first;
  run.count = settings.count.value_or(suite != nullptr ? suite->frames : 1);
  run.folder = settings.folder;
  run.formats = formatsOf(!settings.formats.empty() ? settings.formats
                          : suite != nullptr        ? std::vector{suite->format}
                                                    : std::vector<std::string>{"pcd"});
  run.threads = settings.threads;
  run.resume = settings.resume;
  run.quiet = settings.quiet;
  const SimulationReport report = runSimulation(run);
  writeFileAtomically(run.folder / "description.yaml",
                      fmt::format("# Made by hoist {} with --seed {} --first {} -n {} "
                                  "from this description:\n{}",
                                  HOIST_VERSION,
                                  run.seed,
                                  run.first,
                                  run.count,
                                  text));
  if (!settings.quiet)
    fmt::print(stderr,
               "{} frames{} in {:.1f} s, {:.2f} a second, {:.1f} MB, in {}\n",
               report.frames,
               report.kept > 0 ? fmt::format(" ({} were there)", report.kept) : "",
               report.seconds,
               report.frames / std::max(1e-9, report.seconds),
               static_cast<double>(report.bytes) * 1e-6,
               run.folder.string());
  return exit_ok;
}

} // namespace

Action
addSimulateCommand(CLI::App& program)
{
  CLI::App* command = program.add_subcommand(
      "simulate", "Make frames of worksites with their exact truth, by ray casting");
  auto settings = std::make_shared<SimulateSettings>();
  command->add_option("SCENE", settings->scene, "YAML description of a scene")
      ->check(CLI::ExistingFile)
      ->type_name("");
  command
      ->add_option(
          "--suite", settings->suite, "Instead of a SCENE: a benchmark set of ours")
      ->type_name("NAME");
  command->add_flag("--list-suites", settings->list, "What sets there are");
  command->add_flag(
      "--print", settings->print, "Print the description instead of using it");
  command
      ->add_option(
          "-o,--output", settings->folder, "Folder for the frames; made if missing")
      ->type_name("DIR");
  command
      ->add_option("--seed",
                   settings->seed,
                   "Everything random follows from it (default: the suite's, else 1)")
      ->check(CLI::NonNegativeNumber) // -1 would become the largest seed
      ->type_name("S");
  command
      ->add_option(
          "-n", settings->count, "How many frames (default: all of the suite, else 1)")
      ->check(integerIn(1, 100000000))
      ->type_name("N");
  command
      ->add_option("--first",
                   settings->first,
                   "Number of the first frame: machines can share a set")
      ->check(integerIn(0, 100000000))
      ->capture_default_str()
      ->type_name("K");
  command
      ->add_option("--formats",
                   settings->formats,
                   "pcd, pts (Bumblebee), compact (JPEG and 16-bit PNG); truth and "
                   "labels are always there (default: the suite's, else pcd)")
      ->delimiter(',')
      ->check(CLI::IsMember({"pcd", "pts", "compact"}))
      ->type_name("LIST");
  command->add_option("-j,--threads", settings->threads, "Frames in work at once")
      ->check(integerIn(1, 1024))
      ->capture_default_str()
      ->type_name("N");
  command->add_flag(
      "--resume",
      settings->resume,
      "Leave frames that are in DIR with all their files and the same seed");
  command->add_flag("-q,--quiet", settings->quiet, "No progress on stderr");
  command->footer(
      "\nThe same description, seed and number make the same frame at any "
      "number of threads.\n"
      "Exit codes: 0 done; 1 a file cannot be read or written, e.g. a mesh; "
      "2 unknown option or\nsuite, bad value, on the command line or in the "
      "SCENE.\n"
      "Example: hoist simulate --suite crane-tof -n 20 -o frames\n"
      "         hoist simulate --suite crane-tof --print > scene.yaml\n"
      "         hoist simulate scene.yaml --seed 7 -n 100 -o frames\n");
  return [settings] { return simulateFrames(*settings); };
}

} // namespace hoist
