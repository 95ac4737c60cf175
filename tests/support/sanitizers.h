#pragma once

namespace hoist::test {

/** \brief False where a sanitizer keeps freed memory and shadows the rest, so that the
 * resident size says nothing about the program. */
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool memory_is_measurable = false;
#else
constexpr bool memory_is_measurable = true;
#endif

} // namespace hoist::test
