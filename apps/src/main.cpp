// hoist: cuboids from organized clouds, on the command line.
#include "commands.h"
#include "failures.h"

#include <pcl/console/print.h>

#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>
#include <utility>
#include <vector>

namespace {

const char* const footer =
    "\n"
    "Exit codes: 0 done, also where a frame shows no cuboid; 1 a "
    "file cannot be read or\nwritten; 2 unknown option, bad value "
    "or missing file.\n"
    "Example: hoist recognize frame.pcd -o results\n";

// One line: what is wrong and where help is.
int
usageFailure(const CLI::App& program, const std::string& reason)
{
  std::string name = "hoist";
  for (const CLI::App* command : program.get_subcommands())
    name += " " + command->get_name();
  std::string line = reason;
  for (char& c : line)
    c = c == '\n' ? ' ' : c;
  std::fprintf(
      stderr, "%s: %s (%s --help)\n", name.c_str(), line.c_str(), name.c_str());
  return hoist::exit_usage;
}

} // namespace

int
main(int argc, char** argv)
{
  // Stages explain themselves to PCL's console; the program prints the reason itself.
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);

  CLI::App program("Finds cuboids in organized coloured point clouds: where they are, "
                   "how they lie,\nhow large they are and what colour they have.");
  program.name("hoist");
  program.footer(footer);
  program.set_version_flag("--version", HOIST_VERSION);
  program.require_subcommand(1);
  const std::vector<hoist::Action> actions = {hoist::addRecognizeCommand(program),
                                              hoist::addInfoCommand(program),
                                              hoist::addConvertCommand(program)};
  try {
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
