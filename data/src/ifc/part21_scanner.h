#pragma once

#include <hoist/data/ifc/part21.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace hoist {
namespace part21 {

/** \brief Deeper lists than this are refused; IFC needs four levels. */
constexpr int max_depth = 64;

/** \brief Ids are below this, so that sums of them cannot overflow. */
constexpr std::uint64_t max_id = std::uint64_t(1) << 62;

/** \brief Reads a STEP file byte by byte; knows what was expected where it stops. */
class Scanner {
public:
  Scanner(const std::string& bytes, const std::string& file, std::size_t at = 0)
  : bytes_(&bytes), file_(&file), at_(at)
  {
  }

  std::size_t
  at() const
  {
    return at_;
  }

  /** \brief The byte here; 0 at the end (and for a byte that is 0: see ended()). */
  char
  peek() const
  {
    return at_ < bytes_->size() ? (*bytes_)[at_] : '\0';
  }

  bool
  ended() const
  {
    return at_ >= bytes_->size();
  }

  void
  skip(std::size_t n = 1)
  {
    at_ += n;
  }

  /** \brief Passes spaces and comments. */
  void skipSpace();

  /** \brief Passes \a word if it stands here. */
  bool take(std::string_view word);

  /** \brief Passes \a c or fails; \a where is told, e.g. "behind the id". */
  void expect(char c, const char* where);

  /** \brief Passes a name: letters, digits, underscores. Empty if there is none. */
  std::string_view takeName();

  /** \brief Passes digits.
   *  \throws LoadError if there are none or too many */
  std::uint64_t takeId();

  /** \brief Passes a text, a binary or a list with all that is in it. */
  void passText();
  void passBinary();
  void passList();

  /** \brief Parses the value here. */
  Part21Value value(int depth = 0);

  /** \brief Parses a list's entries, from "(" to ")". */
  std::vector<Part21Value> items(int depth);

  [[noreturn]] void failAt(std::size_t offset, const std::string& reason) const;

  /** \brief "expected ..., found ..." at this place. */
  [[noreturn]] void expected(const std::string& what) const;

private:
  void takeNumber(Part21Value& out);

  const std::string* bytes_;
  const std::string* file_;
  std::size_t at_;
};

/** \brief Throws the LoadError of a place in a file. */
[[noreturn]] void fail(const std::string& bytes,
                       const std::string& file,
                       std::size_t offset,
                       const std::string& reason);

/** \brief A name in upper case. */
std::string upperCase(std::string_view text);

} // namespace part21
} // namespace hoist
