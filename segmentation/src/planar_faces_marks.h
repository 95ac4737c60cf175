#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

namespace hoist {
namespace detail {

constexpr int marks_per_word = 4;

/** \brief Room for one mark per pixel of a row. Marks are set by plain loops that the
 * compiler turns into vector code, and read four at a time: most are zero. */
inline void
resizeMarks(std::vector<short>& marks, int width)
{
  marks.assign(static_cast<std::size_t>(width) + marks_per_word, 0);
}

/** \brief Calls f(u) where mark u < \a width is set, in order; \a f may set the mark
 * u + 1. */
template <typename F>
void
forEachMark(const std::vector<short>& marks, int width, F&& f)
{
  const short* mark = marks.data();
  for (int first = 0; first < width; first += marks_per_word) {
    std::uint64_t word = 0;
    std::memcpy(&word, mark + first, sizeof(word));
    if (word == 0)
      continue;
    const int last = first + marks_per_word < width ? first + marks_per_word : width;
    for (int u = first; u < last; ++u)
      if (mark[u] != 0)
        f(u);
  }
}

} // namespace detail
} // namespace hoist
