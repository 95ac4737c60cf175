#pragma once

#include "batch/inputs.h"
#include "batch/worker.h"

#include <CLI/CLI.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace hoist {

/** \brief All that `hoist batch` can be told. */
struct BatchSettings {
  InputRequest inputs;
  WorkerSettings worker;
  std::size_t jobs = 0;     ///< workers; 0: as many as cores
  std::uint64_t memory = 0; ///< of all together [bytes]
  double timeout = 120;     ///< per file [s]
  std::size_t shard = 1;    ///< this one
  std::size_t shards = 1;   ///< of so many
  bool retry = false;       ///< quarantined files are tried once more
  bool merge_only = false;
  std::size_t report_rows = 1000;

  /// Those options that change results.
  std::vector<CLI::Option*> result_options;
};

/** \brief Adds every option of `hoist batch`. */
void addBatchOptions(CLI::App& command, BatchSettings& settings);

/** \brief Reads the YAML file if one is named and checks what no single option can.
 *  \throws UsageError */
void completeBatchSettings(CLI::App& command, BatchSettings& settings);

/** \brief Adds the options of a worker: those that change results, and its memory. */
void addWorkerOptions(CLI::App& command, WorkerSettings& settings);

} // namespace hoist
