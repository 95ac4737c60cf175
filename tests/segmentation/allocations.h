#pragma once

#include <cstddef>

namespace hoist {
namespace test {

/** \brief How often this program has called operator new so far, in all threads.
 *
 * For programs that are linked with allocations.cpp. */
std::size_t allocations();

} // namespace test
} // namespace hoist
