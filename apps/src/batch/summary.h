#pragma once

#include "batch/record.h"

#include <hoist/data/result.h>

#include <cstddef>
#include <string>

namespace hoist {

/** \brief What a summary of a batch is told of each file, in the order of the names. */
struct SummaryEntry {
  const RecordHead& head;
  const FrameResult& result;    ///< without cuboids where it is quarantined
  const std::string& thumbnail; ///< data URL, or ""
  const std::string& record;    ///< the record's name below the output
};

} // namespace hoist
