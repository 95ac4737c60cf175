#include "batch/batch_settings.h"

#include "batch/memory.h"
#include "failures.h"
#include "validators.h"
#include "yaml_settings.h"

#include <algorithm>
#include <charconv>
#include <thread>

namespace hoist {
namespace {

// "k/N"
void
parseShard(const std::string& text, BatchSettings& settings)
{
  const char* const end = text.data() + text.size();
  std::size_t k = 0, n = 0;
  const auto first = std::from_chars(text.data(), end, k);
  bool good = first.ec == std::errc() && first.ptr < end && *first.ptr == '/';
  if (good) {
    const auto second = std::from_chars(first.ptr + 1, end, n);
    good = second.ec == std::errc() && second.ptr == end;
  }
  if (!good || k < 1 || k > n)
    throw CLI::ValidationError(
        "--shard", "'" + text + "' is not k/N with k from 1 to N, e.g. 3/16");
  settings.shard = k;
  settings.shards = n;
}

std::vector<CLI::Option*>
addResultOptions(CLI::App& command, WorkerSettings& settings)
{
  const std::vector<CLI::Option*> before = command.get_options();
  command
      .add_option("--formats",
                  settings.recognize.formats,
                  "What to write per file, comma separated: json (always), png "
                  "(overlay), csv, pcd (points labelled by cuboid), ply (wireframes)")
      ->delimiter(',')
      ->check(CLI::IsMember({"json", "png", "csv", "pcd", "ply"}))
      ->type_name("LIST")
      ->capture_default_str();
  command
      .add_option("--thumbnail",
                  settings.thumbnail,
                  "Width of the report's pictures [px]; 0: none")
      ->check(integerIn(0, 1024))
      ->type_name("N")
      ->capture_default_str();
  addMethodOptions(command, settings.recognize);
  std::vector<CLI::Option*> added = command.get_options();
  added.erase(std::remove_if(added.begin(),
                             added.end(),
                             [&](CLI::Option* option) {
                               return std::find(before.begin(), before.end(), option) !=
                                      before.end();
                             }),
              added.end());
  return added;
}

void
addInputs(CLI::App& command, BatchSettings& settings)
{
  command
      .add_option("INPUT",
                  settings.inputs.inputs,
                  "Files, folders (with all clouds below them), patterns in quotes, or "
                  "- for a list on the standard input")
      ->configurable(false)
      ->type_name("");
  command
      .add_option("--manifest",
                  settings.inputs.manifests,
                  "File that lists inputs, one per line (or separated by NUL)")
      ->check(CLI::ExistingFile)
      ->configurable(false)
      ->type_name("FILE");
  command.add_option("-o,--out", settings.inputs.out, "Folder for the results")
      ->required()
      ->configurable(false)
      ->type_name("DIR");
  command
      .add_option("-c,--config",
                  settings.worker.recognize.config,
                  "YAML file of settings, as for hoist recognize")
      ->check(CLI::ExistingFile)
      ->configurable(false)
      ->type_name("FILE");
}

void
addRun(CLI::App& command, BatchSettings& settings)
{
  const char* const group = "The run";
  command.add_option("-j,--jobs", settings.jobs, "Files at once; 0: one per core")
      ->check(integerIn(0, 1024))
      ->configurable(false)
      ->type_name("N")
      ->capture_default_str()
      ->group(group);
  command
      .add_option_function<std::string>(
          "--memory",
          [&settings](const std::string& text) { settings.memory = parseMemory(text); },
          "Memory of all together, e.g. 4G; fewer workers where it is too little for "
          "each")
      ->configurable(false)
      ->type_name("SIZE")
      ->default_str("3/4 of the machine's")
      ->group(group);
  command.add_option("--timeout", settings.timeout, "Longest time for a file [s]")
      ->check(numberIn(0.001, 1e6))
      ->configurable(false)
      ->type_name("S")
      ->capture_default_str()
      ->group(group);
  command
      .add_option_function<std::string>(
          "--shard",
          [&settings](const std::string& text) { parseShard(text, settings); },
          "Only the k-th of N parts of the files; then merge with --merge")
      ->configurable(false)
      ->type_name("k/N")
      ->group(group);
  command
      .add_flag(
          "--retry", settings.retry, "Try quarantined files of earlier runs again")
      ->configurable(false)
      ->group(group);
  command
      .add_flag("--merge", settings.merge_only, "Recognise nothing, only merge results")
      ->configurable(false)
      ->group(group);
  command
      .add_option("--report-rows",
                  settings.report_rows,
                  "Files that the report page lists at most")
      ->check(integerIn(0, 1000000))
      ->configurable(false)
      ->type_name("N")
      ->capture_default_str()
      ->group(group);
  command.add_flag("-q,--quiet", settings.worker.recognize.quiet, "No progress")
      ->configurable(false)
      ->group(group);
}

} // namespace

void
addBatchOptions(CLI::App& command, BatchSettings& settings)
{
  settings.worker.recognize.formats = {"json"};
  addInputs(command, settings);
  addRun(command, settings);
  settings.result_options = addResultOptions(command, settings.worker);
}

void
completeBatchSettings(CLI::App& command, BatchSettings& settings)
{
  if (!settings.worker.recognize.config.empty())
    applyYaml(command, settings.worker.recognize.config);
  checkMethod(settings.worker.recognize);
  if (settings.inputs.inputs.empty() && settings.inputs.manifests.empty())
    throw UsageError("no INPUT and no --manifest");
  if (settings.merge_only && settings.shards > 1)
    throw UsageError("--merge is for all shards together, not for one");
  if (settings.jobs == 0)
    settings.jobs = std::max(1u, std::thread::hardware_concurrency());
  if (settings.memory == 0)
    settings.memory = defaultMemory();
}

void
addWorkerOptions(CLI::App& command, WorkerSettings& settings)
{
  settings.recognize.formats = {"json"};
  command.add_option("--memory", settings.memory);
  (void)addResultOptions(command, settings);
}

} // namespace hoist
