#pragma once

#include "batch/message.h"
#include "settings.h"

#include <cstdint>

namespace hoist {

/** \brief What a worker is told at its start. */
struct WorkerSettings {
  RecognizeSettings recognize;
  int thumbnail = 160;      ///< columns; 0 for none
  std::uint64_t memory = 0; ///< bytes of its own that it may have; 0: any
};

/** \brief The words that begin a worker's messages. */
namespace words {
/// {ready}: once, at the start.
constexpr const char* ready = "ready";
/// {done, result's JSON, thumbnail, microseconds of reading, of recognition, of all,
/// then suffix and bytes of every file beside the record}
constexpr const char* done = "done";
/// {input, reason}: the file is at fault.
constexpr const char* input = "input";
/// {memory, reason}: the limit is too low for the file; the worker ends itself.
constexpr const char* memory = "memory";
} // namespace words

/** \brief The life of a worker: takes {path} after {path} from the socket and answers
 *  each, until the other end goes. It writes no file: whatever a cloud does to it, the
 *  results of others are out of its reach.
 *  \return exit code */
int runWorker(const WorkerSettings& settings, int socket);

} // namespace hoist
