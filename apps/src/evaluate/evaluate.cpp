#include "commands.h"
#include "evaluate/evaluation.h"
#include "evaluate/plots.h"
#include "evaluate/report_json.h"
#include "evaluate/report_text.h"
#include "failures.h"
#include "validators.h"

#include <hoist/data/atomic_file.h>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

namespace hoist {
namespace {

const char* const footer =
    "\n"
    "A hit overlaps something not yet hit by at least the IoU; the highest score comes "
    "first.\nWhat belongs to something difficult counts neither as hit nor as wrong. "
    "Errors,\nattributes and calibration are those of hits at the first IoU.\n"
    "Exit codes: 0 done; 1 a file is broken or cannot be written; 2 unknown option, "
    "bad value,\nmissing file, or nothing in RESULTS belongs to anything in TRUTH.\n"
    "Example: hoist recognize scenes/*.pcd -o found --formats json\n"
    "         hoist evaluate truth found --iou 0.25,0.5,0.75 --plots plots\n";

void
makeFolder(const std::string& folder)
{
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder))
    throw FileError(
        folder + ": cannot be made: " + (error ? error.message() : "it is no folder"));
}

int
run(const EvaluateSettings& settings)
{
  const EvaluatedScenes loaded = loadScenes(settings);
  for (const std::string& note : loaded.notes)
    fmt::print(stderr, "hoist evaluate: note: {}\n", note);
  const Evaluation evaluation = evaluateScenes(loaded.scenes, settings);
  if (settings.json != "-") {
    fmt::print("{}", evaluationText(loaded.scenes, evaluation, settings));
    if (settings.list)
      fmt::print("{}", missesText(loaded.scenes, evaluation));
  }
  if (!settings.json.empty()) {
    const std::string json = evaluationJson(loaded.scenes, evaluation, settings);
    if (settings.json == "-")
      fmt::print("{}", json);
    else
      writeFileAtomically(settings.json, json);
  }
  if (!settings.plots.empty()) {
    makeFolder(settings.plots);
    writePlots(settings.plots, evaluation);
  }
  return exit_ok;
}

} // namespace

Action
addEvaluateCommand(CLI::App& program)
{
  CLI::App* command = program.add_subcommand(
      "evaluate", "Compare results with what is true: found, missed, how exact");
  auto settings = std::make_shared<EvaluateSettings>();
  EvaluateSettings& s = *settings;
  command->add_option("TRUTH", s.truth, "Annotation, or a folder of them: what is true")
      ->required()
      ->check(CLI::ExistingPath)
      ->type_name("");
  command
      ->add_option("RESULTS",
                   s.results,
                   "What hoist recognize or hoist batch wrote, a file or a folder; "
                   "or JSON of others with the list \"cuboids\"")
      ->required()
      ->check(CLI::ExistingPath)
      ->type_name("");
  command
      ->add_option(
          "--of", s.of, "What is compared: cuboids, objects (of other shapes), all")
      ->check(CLI::IsMember({"cuboids", "objects", "all"}))
      ->type_name("WHAT")
      ->capture_default_str();
  command
      ->add_option("--iou", s.ious, "Shared volume over joint volume of a hit; a list")
      ->delimiter(',')
      ->allow_extra_args(false) // TRUTH may follow
      ->check(numberIn(0.001, 1))
      ->type_name("LIST")
      ->capture_default_str();
  command
      ->add_option("--min-score", s.min_score, "Leave out predictions below this score")
      ->check(numberIn(-1e9, 1e9))
      ->type_name("S")
      ->capture_default_str();
  command
      ->add_option("--ignore-iou",
                   s.ignore_iou,
                   "IoU with a difficult thing from which a prediction belongs to it")
      ->check(numberIn(0.001, 1))
      ->type_name("X")
      ->capture_default_str();
  command
      ->add_option("--ignore-share",
                   s.ignore_share,
                   "Or this share of the prediction lies inside of a difficult thing")
      ->check(numberIn(0.001, 1))
      ->type_name("X")
      ->capture_default_str();
  command
      ->add_option("--color-tolerance",
                   s.color_tolerance,
                   "A colour is right within this share of the range, on every channel")
      ->check(numberIn(0, 1))
      ->type_name("X")
      ->capture_default_str();
  command
      ->add_option("--json",
                   s.json,
                   "Write all figures to FILE; - for stdout, instead of the tables")
      ->type_name("FILE");
  command->add_option("--plots", s.plots, "Draw the figures as PNG into DIR")
      ->type_name("DIR");
  command->add_flag(
      "--list", s.list, "Tell what was missed and what is wrong, scene by scene");
  command->footer(footer);
  return [settings] { return run(*settings); };
}

} // namespace hoist
