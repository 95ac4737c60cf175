#include "chunk_reader.h"

#include <hoist/data/load_error.h>

#include <sys/stat.h>

#include <cerrno>
#include <cstring>

namespace hoist {
namespace detail {

ChunkReader::ChunkReader(const std::string& file, std::size_t offset)
: name_(file), offset_(offset)
{
  struct stat info {};
  if (::stat(file.c_str(), &info) != 0)
    throw LoadError(file, "", std::strerror(errno));
  if (!S_ISREG(info.st_mode)) // a pipe cannot be read twice, a folder not at all
    throw LoadError(file, "", "is not a regular file");
  file_.reset(std::fopen(file.c_str(), "rb"));
  if (!file_)
    throw LoadError(file, "", std::strerror(errno));
  std::setvbuf(file_.get(), nullptr, _IONBF, 0);
  buffer_.resize(chunk_size + max_line + 1);
  // the byte order mark of UTF-8
  rewind();
  char mark[3] = {};
  if (std::fread(mark, 1, 3, file_.get()) == 3 &&
      std::memcmp(mark, "\xef\xbb\xbf", 3) == 0)
    offset_ += 3;
  rewind();
}

void
ChunkReader::rewind()
{
  std::clearerr(file_.get());
  if (::fseeko(file_.get(), static_cast<off_t>(offset_), SEEK_SET) != 0)
    throw LoadError(name_, "", std::strerror(errno));
  kept_ = kept_from_ = 0;
  ended_ = false;
}

bool
ChunkReader::next(const char*& begin, const char*& end)
{
  if (ended_)
    return false;
  char* const data = buffer_.data();
  if (kept_ > 0)
    std::memmove(data, data + kept_from_, kept_);
  const std::size_t got = std::fread(data + kept_, 1, chunk_size, file_.get());
  if (got < chunk_size && std::ferror(file_.get()) != 0)
    throw LoadError(name_, "", "cannot be read to its end");
  std::size_t size = kept_ + got;
  if (got < chunk_size) {
    ended_ = true;
    if (size == 0)
      return false;
    if (data[size - 1] != '\n')
      data[size++] = '\n';
  }
  std::size_t stop = size;
  while (stop > 0 && data[stop - 1] != '\n')
    --stop;
  kept_from_ = stop;
  kept_ = size - stop;
  if (kept_ > max_line)
    throw LoadError(name_,
                    "",
                    "has a line of more than " + std::to_string(max_line) +
                        " bytes: this is no text with one point per line");
  begin = data;
  end = data + stop;
  return true;
}

} // namespace detail
} // namespace hoist
