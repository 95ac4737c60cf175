#pragma once

#include "batch/inputs.h"
#include "batch/record_check.h"
#include "batch/stop_signal.h"
#include "batch/store.h"

#include <cstddef>
#include <string>
#include <vector>

namespace hoist {

/** \brief What a merge found. */
struct MergeCounts {
  std::size_t files = 0;
  std::size_t quarantined = 0;
  std::size_t cuboids = 0;
  std::size_t missing = 0;   ///< files without a record that stands
  std::string first_missing; ///< a path
};

/** \brief Writes files.csv, cuboids.csv, summary.sqlite and report.html from the
 * records of \a files, in their order: the same records, the same bytes.
 *
 * Where records are missing, or a signal comes, nothing is written.
 * \param settings all settings as text
 * \throws StoreError */
MergeCounts mergeRecords(Store& store,
                         const RecordCheck& check,
                         const std::vector<InputFile>& files,
                         const std::string& settings,
                         std::size_t most_rows,
                         const StopSignal& stop);

} // namespace hoist
