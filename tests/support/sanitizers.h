#pragma once

namespace hoist::test {

/** \brief False where a sanitizer keeps freed memory and shadows the rest, so that the
 * resident size says nothing about the program. */
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool memory_is_measurable = false;
#else
constexpr bool memory_is_measurable = true;
#endif

/** \brief How many draws a statistical test takes of the \a n that it takes elsewhere:
 * under a sanitizer, which makes them ten to thirty times slower, a quarter goes the
 * same ways through the code. */
constexpr int
draws(int n)
{
  return memory_is_measurable ? n : (n + 3) / 4;
}

} // namespace hoist::test
