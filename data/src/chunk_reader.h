#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace hoist {
namespace detail {

/** \brief Gives a text file in chunks of whole lines, in bounded memory. */
class ChunkReader {
public:
  static constexpr std::size_t chunk_size = std::size_t(1) << 20;
  static constexpr std::size_t max_line = std::size_t(1) << 16;

  /** \throws LoadError if it is no readable regular file */
  ChunkReader(const std::string& file, std::size_t offset);

  /** \brief The next whole lines; the last line gets its line end if it lacks one.
   *  \return false at the end of the file
   *  \throws LoadError on a line longer than max_line or a read error */
  bool next(const char*& begin, const char*& end);

  /** \brief Back to the start. */
  void rewind();

private:
  struct Close {
    void
    operator()(std::FILE* f) const
    {
      std::fclose(f);
    }
  };

  std::string name_;
  std::size_t offset_;
  std::unique_ptr<std::FILE, Close> file_;
  std::vector<char> buffer_;
  std::size_t kept_ = 0;      // bytes of an unfinished line at the buffer's start ...
  std::size_t kept_from_ = 0; // ... which lie here until the next call
  bool ended_ = false;
};

} // namespace detail
} // namespace hoist
