#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

namespace hoist {
namespace detail {

/** \brief One mark per pixel of a row, set by plain loops that the compiler turns into
 * vector code, read four at a time: most are zero. */
class RowMarks {
public:
  void
  resize(int count)
  {
    count_ = count;
    marks_.assign(static_cast<std::size_t>(count) + per_word, 0);
  }

  short*
  data()
  {
    return marks_.data();
  }

  /** \brief Calls f(i) where mark i is set, in order; \a f may set the mark i + 1. */
  template <typename F>
  void
  forEach(F&& f)
  {
    for (int first = 0; first < count_; first += per_word) {
      std::uint64_t word = 0;
      std::memcpy(&word, &marks_[first], sizeof(word));
      if (word == 0)
        continue;
      const int last = first + per_word < count_ ? first + per_word : count_;
      for (int i = first; i < last; ++i)
        if (marks_[i] != 0)
          f(i);
    }
  }

private:
  static constexpr int per_word = 4;
  std::vector<short> marks_; // and one word more
  int count_ = 0;
};

} // namespace detail
} // namespace hoist
