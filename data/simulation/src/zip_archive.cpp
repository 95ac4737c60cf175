#include "zip_archive.h"

#include "read_file.h"
#include <hoist/data/load_error.h>

#include <zlib.h>

#include <utility>

namespace hoist {
namespace simulation {
namespace {

constexpr std::uint32_t largest = 1U << 30; // of a file in it [bytes]

} // namespace

std::uint32_t
ZipArchive::number(std::size_t at, int bytes) const
{
  if (at + static_cast<std::size_t>(bytes) > bytes_.size())
    throw LoadError(file_, "byte " + std::to_string(at), "the archive is cut off");
  std::uint32_t value = 0;
  for (int i = bytes - 1; i >= 0; --i)
    value = value << 8 |
            static_cast<unsigned char>(bytes_[at + static_cast<std::size_t>(i)]);
  return value;
}

ZipArchive::ZipArchive(const std::string& file) : file_(file)
{
  std::optional<std::string> content = readFile(file);
  if (!content)
    throw LoadError(file, "", "cannot be read");
  bytes_ = std::move(*content);
  const std::size_t end = bytes_.rfind("PK\5\6");
  if (end == std::string::npos)
    throw LoadError(file, "", "is no ZIP archive");
  const std::uint32_t count = number(end + 10, 2);
  std::size_t at = number(end + 16, 4);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (number(at, 4) != 0x02014b50)
      throw LoadError(file, "byte " + std::to_string(at), "expected an entry");
    Entry entry{};
    entry.method = static_cast<std::uint16_t>(number(at + 10, 2));
    entry.packed = number(at + 20, 4);
    entry.size = number(at + 24, 4);
    entry.offset = number(at + 42, 4);
    const std::uint32_t length = number(at + 28, 2);
    if (at + 46 + length > bytes_.size())
      throw LoadError(file, "byte " + std::to_string(at), "the archive is cut off");
    entries_[bytes_.substr(at + 46, length)] = entry;
    at += 46 + length + number(at + 30, 2) + number(at + 32, 2);
  }
}

std::string
ZipArchive::read(const std::string& name) const
{
  const auto found = entries_.find(name);
  if (found == entries_.end())
    throw LoadError(file_, "", "holds no '" + name + "'");
  const Entry& entry = found->second;
  const std::size_t data = entry.offset + 30ULL + number(entry.offset + 26, 2) +
                           number(entry.offset + 28, 2);
  if (data + entry.packed > bytes_.size() || entry.size > largest)
    throw LoadError(file_, "", "'" + name + "' is cut off");
  if (entry.method == 0)
    return bytes_.substr(data, entry.packed);
  std::string out(entry.size, '\0');
  z_stream stream{};
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(&bytes_[data]));
  stream.avail_in = entry.packed;
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = entry.size;
  // a negative window: without zlib's own header
  const bool good = entry.method == 8 && inflateInit2(&stream, -MAX_WBITS) == Z_OK &&
                    inflate(&stream, Z_FINISH) == Z_STREAM_END &&
                    stream.total_out == entry.size;
  inflateEnd(&stream);
  if (!good)
    throw LoadError(file_, "", "'" + name + "' is damaged");
  return out;
}

} // namespace simulation
} // namespace hoist
