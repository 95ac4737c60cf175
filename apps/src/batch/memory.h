#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace hoist {

/** \brief "500M", "4G", "1.5T", or bytes; powers of 1024.
 *  \throws CLI::ValidationError */
std::uint64_t parseMemory(const std::string& text);

/** \brief "4 GB", "1.5 GB", "500 MB". */
std::string memoryText(std::uint64_t bytes);

/** \brief Three quarters of what the machine, or the container, has. */
std::uint64_t defaultMemory();

/** \brief How a batch divides its memory. */
struct MemoryPlan {
  std::size_t workers;  ///< at most what was asked for
  std::uint64_t share;  ///< bytes for each of them
  std::uint64_t single; ///< bytes for one that works alone
};

/** \brief Divides \a memory among at most \a workers so that the sum with the batch's
 *  own is kept, and each has enough for a common frame.
 *  \param files of the whole batch: their names take memory too
 *  \throws UsageError if it is too little for one */
MemoryPlan planMemory(std::uint64_t memory, std::size_t workers, std::size_t files);

} // namespace hoist
