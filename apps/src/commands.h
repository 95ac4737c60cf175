#pragma once

#include <CLI/CLI.hpp>

#include <functional>

namespace hoist {

/** \brief Runs a command whose options have been parsed; returns an ExitCode.
 *  \throws UsageError, FileError */
using Action = std::function<int()>;

/** \brief Adds the command to \a program. Its settings live in the returned action. */
Action addRecognizeCommand(CLI::App& program);

Action addInfoCommand(CLI::App& program);

Action addConvertCommand(CLI::App& program);

Action addBatchCommand(CLI::App& program);

/** \brief Only where the simulator is built (HOIST_BUILD_SIMULATION). */
Action addSimulateCommand(CLI::App& program);

Action addEvaluateCommand(CLI::App& program);

Action addCocoCommand(CLI::App& program);

Action addIfcCommand(CLI::App& program);

/** \brief The hidden command that `hoist batch` starts its workers with. */
Action addBatchWorkerCommand(CLI::App& program);

} // namespace hoist
