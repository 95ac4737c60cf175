// hoist: cuboids from organized clouds, on the command line.
#include "commands.h"
#include "failures.h"
#include "help.h"

#include <pcl/console/print.h>

#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace {

const char* const footer =
    "\n"
    "Exit codes: 0 done, also where a frame shows no cuboid; 1 a "
    "file cannot be read or\nwritten; 2 unknown option, bad value "
    "or missing file; of batch also 3 some files are\nquarantined; 75 not all "
    "done, run again.\n"
    "Example: hoist recognize frame.pcd -o results\n";

// One line: what is wrong and where help is.
int
usageFailure(const CLI::App& program, const std::string& reason)
{
  std::string name = "hoist";
  for (std::vector<CLI::App*> parsed = program.get_subcommands(); !parsed.empty();
       parsed = parsed.front()->get_subcommands())
    name += " " + parsed.front()->get_name();
  std::string line = reason;
  for (char& c : line)
    c = c == '\n' ? ' ' : c;
  std::fprintf(
      stderr, "%s: %s (%s --help)\n", name.c_str(), line.c_str(), name.c_str());
  return hoist::exit_usage;
}

// A command or a long option that does not exist. CLI11 would complain of what follows
// from it instead, e.g. of the option's value as a file that is missing.
std::string
unknownWord(const CLI::App& program, int argc, char** argv)
{
  const CLI::App* command = &program;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--")
      break;
    if (word.rfind("--", 0) == 0) {
      if (command->get_option_no_throw(word.substr(0, word.find('='))) == nullptr)
        return "unknown option " + word.substr(0, word.find('='));
    }
    else if (!command->get_subcommands({}).empty() && word.rfind('-', 0) != 0) {
      const std::vector<const CLI::App*> found = command->get_subcommands(
          [&](const CLI::App* one) { return one->get_name() == word; });
      if (found.empty())
        return "unknown command '" + word + "'";
      command = found.front();
    }
  }
  return "";
}

} // namespace

int
main(int argc, char** argv)
{
  // Stages explain themselves to PCL's console; the program prints the reason itself.
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);

  CLI::App program("Finds cuboids in organized coloured point clouds: where they are, "
                   "how they lie,\nhow large they are and what colour they have.");
  program.formatter(std::make_shared<hoist::HelpFormatter>()); // commands inherit it
  program.name("hoist");
  program.footer(footer);
  program.set_version_flag("--version", HOIST_VERSION);
  program.require_subcommand(1);
  const std::vector<hoist::Action> actions = {hoist::addRecognizeCommand(program),
                                              hoist::addInfoCommand(program),
                                              hoist::addConvertCommand(program),
                                              hoist::addBatchCommand(program),
#ifdef HOIST_WITH_SIMULATION
                                              hoist::addSimulateCommand(program),
#endif
                                              hoist::addBatchWorkerCommand(program),
                                              hoist::addEvaluateCommand(program),
                                              hoist::addCocoCommand(program),
                                              hoist::addIfcCommand(program)};
  try {
    const std::string unknown = unknownWord(program, argc, argv);
    if (!unknown.empty())
      return usageFailure(program, unknown);
    program.parse(argc, argv);
    const std::vector<CLI::App*> commands = program.get_subcommands({});
    for (std::size_t i = 0; i < commands.size(); ++i)
      if (commands[i]->parsed())
        return actions.at(i)();
    return hoist::exit_usage;
  }
  catch (const CLI::Success& help) {
    return program.exit(help);
  }
  catch (const CLI::Error& error) {
    return usageFailure(program, error.what());
  }
  catch (const hoist::UsageError& error) {
    return usageFailure(program, error.what());
  }
  catch (const std::exception& error) {
    std::fprintf(stderr, "hoist: %s\n", error.what());
    return hoist::exit_input;
  }
}
