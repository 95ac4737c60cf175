// hoist ifc: building models, read, made and brought up to date.
#include "commands.h"
#include "failures.h"
#include "ifc/model_report.h"
#include "ifc/seen_in.h"
#include "validators.h"

#include <hoist/data/atomic_file.h>
#include <hoist/data/ifc/ifc_edit.h>
#include <hoist/data/ifc/ifc_journal.h>
#include <hoist/data/ifc/ifc_observe.h>

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace hoist {
namespace {

namespace fs = std::filesystem;

const char* const update_footer =
    "\n"
    "Things that overlap an element of the model, or were put there by an earlier "
    "update, are\nthat element; others are added. The update can be taken back with "
    "hoist ifc undo.\n"
    "Exit codes: 0 done; 1 a file is broken or cannot be written; 2 unknown option, "
    "bad "
    "value\nor missing file.\n"
    "Example: hoist ifc update site.ifc results/*.json --dry-run\n";

const char* const footer = "\n"
                           "Exit codes: 0 done; 1 a file is broken or cannot be "
                           "written; 2 unknown option, bad "
                           "value\nor missing file.\n"
                           "Example: hoist ifc info site.ifc\n";

struct IfcSettings {
  std::string model;
  std::vector<std::string> results;
  std::string output;
  std::string schema = "IFC4";
  std::string unit = "m";
  std::string name;
  bool json = false;
  bool dry_run = false;
  bool camera_frame = false;
  IfcObserveSettings observe;
};

const std::map<std::string, double>&
units()
{
  static const std::map<std::string, double> all = {{"m", 1},
                                                    {"dm", 0.1},
                                                    {"cm", 0.01},
                                                    {"mm", 0.001},
                                                    {"in", 0.0254},
                                                    {"ft", 0.3048}};
  return all;
}

std::vector<IfcObservation>
observationsOf(const IfcSettings& settings)
{
  std::vector<IfcObservation> out;
  for (const std::string& file : settings.results)
    for (IfcObservation& seen : seenIn(file, settings.camera_frame))
      out.push_back(std::move(seen));
  return out;
}

// "3 added, 1 moved"
std::string
summary(const std::vector<IfcOutcome>& outcomes)
{
  std::map<std::string, int> counts;
  for (const IfcOutcome& one : outcomes)
    ++counts[one.outcome];
  std::string out;
  for (const auto& [word, count] : counts)
    out += (out.empty() ? "" : ", ") + std::to_string(count) + ' ' + word;
  return out.empty() ? "nothing was seen" : out;
}

int
showModel(const IfcSettings& settings)
{
  const IfcModel model = IfcModel::load(settings.model);
  fmt::print("{}", settings.json ? modelJson(model) : modelTable(model));
  return exit_ok;
}

int
createModel(const IfcSettings& settings)
{
  IfcNewModel made;
  made.schema = settings.schema == "IFC4" ? IfcSchema::ifc4 : IfcSchema::ifc2x3;
  made.length_unit = units().at(settings.unit);
  made.name =
      settings.name.empty() ? fs::path(settings.output).stem().string() : settings.name;
  if (fs::exists(settings.output))
    throw UsageError(settings.output +
                     " is there already; hoist ifc update changes it");
  const IfcModel model(Part21File::parse(newIfcModel(made), settings.output));
  IfcEdit edit(model);
  const auto outcomes = observeIfc(edit, model, observationsOf(settings));
  writeFileAtomically(settings.output, edit.part21().bytes());
  fmt::print("{}: {}\n", settings.output, summary(outcomes));
  return exit_ok;
}

int
updateModel(const IfcSettings& settings)
{
  const std::vector<IfcObservation> observations = observationsOf(settings);
  const IfcModel model = IfcModel::load(settings.model);
  IfcEdit edit(model);
  const auto outcomes = observeIfc(edit, model, observations, settings.observe);
  for (const IfcOutcome& one : outcomes)
    fmt::print("{:12} {:22}  {}{}\n",
               one.outcome,
               one.global_id,
               one.key,
               one.detail.empty() ? "" : "  " + one.detail);
  if (settings.dry_run) {
    fmt::print("{}", edit.part21().diff());
    fmt::print("{}: {}; nothing is written\n", settings.model, summary(outcomes));
    return exit_ok;
  }
  const bool changed = commitIfc(settings.model, edit.part21());
  fmt::print("{}: {}{}\n",
             settings.model,
             summary(outcomes),
             changed ? "" : "; the file is as it was");
  return exit_ok;
}

int
undoUpdate(const IfcSettings& settings)
{
  const bool undone = undoIfc(settings.model);
  fmt::print("{}: {}\n",
             settings.model,
             undone ? "is as it was before the last update" : "no update to undo");
  return exit_ok;
}

CLI::App*
addVerb(CLI::App& command, const char* name, const char* what, IfcSettings& s)
{
  CLI::App* verb = command.add_subcommand(name, what);
  if (std::string(name) != "create")
    verb->add_option("MODEL", s.model, "Building model (.ifc)")
        ->required()
        ->check(CLI::ExistingFile)
        ->type_name("");
  return verb;
}

void
addCameraFrame(CLI::App& verb, IfcSettings& s)
{
  verb.add_flag("--camera-frame",
                s.camera_frame,
                "Take the camera's frame for the world's where results have no pose");
}

void
addUpdateOptions(CLI::App& verb, IfcSettings& s)
{
  verb.add_option("RESULTS", s.results, "Results or annotations (JSON)")
      ->required()
      ->check(CLI::ExistingFile)
      ->type_name("");
  verb.add_flag("--dry-run", s.dry_run, "Show what would change, write nothing");
  verb.add_flag("--move-others",
                s.observe.move_others,
                "Move what others modelled to where it was seen; else that it deviates "
                "is recorded");
  verb.add_option("--storey",
                  s.observe.storey,
                  "Name or GlobalId of the storey for new things; default: the one "
                  "they stand on")
      ->type_name("NAME");
  verb.add_option("--min-overlap",
                  s.observe.min_overlap,
                  "Intersection over union of what is the same thing")
      ->check(numberIn(0.01, 1))
      ->type_name("X")
      ->capture_default_str();
  verb.add_option("--distance",
                  s.observe.distance,
                  "Metres that an element may be off before it counts as moved, or "
                  "three sigma if that is more")
      ->check(numberIn(0, 1000))
      ->type_name("M")
      ->capture_default_str();
  verb.add_option("--angle", s.observe.angle, "Degrees, likewise")
      ->check(numberIn(0, 90))
      ->type_name("DEG")
      ->capture_default_str();
  addCameraFrame(verb, s);
  verb.footer(update_footer);
}

} // namespace

Action
addIfcCommand(CLI::App& program)
{
  CLI::App* command =
      program.add_subcommand("ifc", "Read, make and update building models (IFC)");
  command->require_subcommand(1);
  command->footer(footer); // of its verbs, too
  auto settings = std::make_shared<IfcSettings>();
  IfcSettings& s = *settings;

  CLI::App* info = addVerb(*command, "info", "List the elements of a model", s);
  info->add_flag("--json", s.json, "As JSON, with property sets");

  CLI::App* create = addVerb(*command, "create", "Make a model, with things in it", s);
  create->add_option("RESULTS", s.results, "Results or annotations (JSON) to put in")
      ->check(CLI::ExistingFile)
      ->type_name("");
  create->add_option("-o,--output", s.output, "The model to write (.ifc)")
      ->required()
      ->type_name("FILE");
  create->add_option("--schema", s.schema, "IFC4 or IFC2X3")
      ->check(CLI::IsMember({"IFC4", "IFC2X3"}))
      ->type_name("NAME")
      ->capture_default_str();
  create->add_option("--unit", s.unit, "Of length: m, dm, cm, mm, in or ft")
      ->check(CLI::IsMember(units()))
      ->type_name("UNIT")
      ->capture_default_str();
  create->add_option("--name", s.name, "Of the project; default: the file's")
      ->type_name("NAME");
  addCameraFrame(*create, s);

  CLI::App* update =
      addVerb(*command, "update", "Bring a model up to date with what was seen", s);
  addUpdateOptions(*update, s);
  CLI::App* undo = addVerb(*command, "undo", "Take the last update back", s);

  const std::vector<std::pair<CLI::App*, int (*)(const IfcSettings&)>> verbs = {
      {info, showModel},
      {create, createModel},
      {update, updateModel},
      {undo, undoUpdate}};
  return [settings, verbs] {
    for (const auto& [verb, run] : verbs)
      if (verb->parsed())
        return run(*settings);
    return static_cast<int>(exit_usage);
  };
}

} // namespace hoist
