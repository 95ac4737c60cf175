// PCD 0.5 to 0.7. PCL's own reader is not called: it trusts the header, and two parsers
// that disagree on one header would be a hole. Every number of the header is checked
// against the bytes that are there before memory is asked for.
#include "chunk_reader.h"
#include "header_text.h"
#include "parse_number.h"
#include "raw_cloud.h"

#include <pcl/io/lzf.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>

namespace hoist {
namespace detail {
namespace {

constexpr std::size_t max_header = std::size_t(1) << 16;
constexpr std::size_t max_fields = 256;
constexpr std::uint64_t max_count = 1 << 16;
// LZF's shortest code for its longest run: 3 bytes give 264.
constexpr std::uint64_t lzf_ratio = 88;

struct Field {
  std::string name;
  NumberType type;
  std::uint64_t count = 1;
  std::uint64_t offset = 0;
};

struct Header {
  std::vector<Field> fields;
  std::optional<std::uint64_t> width, height, points;
  std::array<double, 7> viewpoint = {0, 0, 0, 1, 0, 0, 0};
  std::string data;
  std::size_t size = 0; // where the data starts
  std::size_t lines = 0;
  std::uint64_t step = 0;
};

// Reads the header's lines one by one; knows the file and the line for messages.
class HeaderParser {
public:
  HeaderParser(const std::string& file, const std::string& head)
  : file_(file), head_(head)
  {
  }

  Header
  parse()
  {
    while (header_.data.empty()) {
      const std::size_t stop = head_.find('\n', at_);
      if (stop == std::string::npos)
        throw LoadError(file_,
                        "",
                        head_.size() >= max_header
                            ? "no DATA line in its first " +
                                  std::to_string(max_header) + " bytes"
                            : "the header ends before its DATA line");
      ++header_.lines;
      parseLine(split(head_.substr(at_, stop - at_), max_fields + 2));
      at_ = stop + 1;
    }
    header_.size = at_;
    finish();
    return header_;
  }

private:
  [[noreturn]] void
  fail(const std::string& reason) const
  {
    throw LoadError(file_, std::to_string(header_.lines), reason);
  }

  std::uint64_t
  whole(const std::string& text, const char* what) const
  {
    std::uint64_t value = 0;
    const auto [stop, error] =
        std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || stop != text.data() + text.size())
      fail(std::string("expected a whole number for ") + what + ", found " +
           shown(text));
    return value;
  }

  std::uint64_t
  only(const std::vector<std::string>& words) const
  {
    if (words.size() != 2)
      fail(words[0] + " takes one number");
    return whole(words[1], words[0].c_str());
  }

  // One value per field.
  void
  expectPerField(const std::vector<std::string>& words) const
  {
    if (header_.fields.empty())
      fail(words[0] + " comes before FIELDS");
    if (words.size() - 1 != header_.fields.size())
      fail(words[0] + " has " + std::to_string(words.size() - 1) + " entries for " +
           std::to_string(header_.fields.size()) + " fields");
  }

  void
  parseLine(const std::vector<std::string>& words)
  {
    if (words.empty() || words[0][0] == '#')
      return;
    const std::string& key = words[0];
    if (key == "VERSION")
      return;
    if (key == "FIELDS" || key == "COLUMNS") {
      if (!header_.fields.empty())
        fail("a second FIELDS line");
      if (words.size() < 2 || words.size() > max_fields + 1)
        fail("expected 1 to " + std::to_string(max_fields) + " field names");
      for (std::size_t i = 1; i < words.size(); ++i) {
        Field field;
        field.name = words[i];
        header_.fields.push_back(field);
      }
    }
    else if (key == "SIZE") {
      expectPerField(words);
      for (std::size_t i = 1; i < words.size(); ++i) {
        const std::uint64_t size = whole(words[i], "SIZE");
        if (size != 1 && size != 2 && size != 4 && size != 8)
          fail("expected a SIZE of 1, 2, 4 or 8, found " + shown(words[i]));
        header_.fields[i - 1].type.size = static_cast<unsigned>(size);
      }
    }
    else if (key == "TYPE") {
      expectPerField(words);
      for (std::size_t i = 1; i < words.size(); ++i) {
        if (words[i] != "F" && words[i] != "I" && words[i] != "U")
          fail("expected a TYPE of F, I or U, found " + shown(words[i]));
        header_.fields[i - 1].type.kind = words[i][0];
      }
    }
    else if (key == "COUNT") {
      expectPerField(words);
      for (std::size_t i = 1; i < words.size(); ++i) {
        const std::uint64_t count = whole(words[i], "COUNT");
        if (count < 1 || count > max_count)
          fail("expected a COUNT from 1 to " + std::to_string(max_count) + ", found " +
               shown(words[i]));
        header_.fields[i - 1].count = count;
      }
    }
    else if (key == "WIDTH")
      header_.width = only(words);
    else if (key == "HEIGHT")
      header_.height = only(words);
    else if (key == "POINTS")
      header_.points = only(words);
    else if (key == "VIEWPOINT") {
      if (words.size() != 8)
        fail("expected 7 numbers after VIEWPOINT");
      for (int i = 0; i < 7; ++i) {
        const std::string text = words[i + 1] + '\n';
        const char* stop = parseReal(text.c_str(), header_.viewpoint[i]);
        if (stop == nullptr || *stop != '\n' || !std::isfinite(header_.viewpoint[i]))
          fail("expected a number in VIEWPOINT, found " + shown(words[i + 1]));
      }
    }
    else if (key == "DATA") {
      if (words.size() != 2 || (words[1] != "ascii" && words[1] != "binary" &&
                                words[1] != "binary_compressed"))
        fail("expected DATA ascii, binary or binary_compressed");
      header_.data = words[1];
    }
    else
      fail("expected a line of a PCD header, found " + shown(key));
  }

  void
  finish()
  {
    if (header_.fields.empty())
      fail("the header has no FIELDS line");
    if (!header_.width && !header_.points)
      fail("the header has neither WIDTH nor POINTS");
    // PCD 0.5 knew no WIDTH and HEIGHT
    if (!header_.width) {
      header_.width = header_.points;
      header_.height = 1;
    }
    if (!header_.height)
      header_.height = 1;
    const std::uint64_t w = *header_.width, h = *header_.height;
    constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
    if (w > most || h > most)
      fail("the cloud's size " + std::to_string(w) + " x " + std::to_string(h) +
           " is absurd");
    if (header_.points && *header_.points != w * h)
      fail("POINTS " + std::to_string(*header_.points) + " is not WIDTH x HEIGHT, " +
           std::to_string(w * h));
    header_.points = w * h;
    for (Field& field : header_.fields) {
      if (field.type.kind == 'F' && field.type.size < 4)
        fail("field " + shown(field.name) + ": a float of " +
             std::to_string(field.type.size) + " bytes");
      field.offset = header_.step;
      header_.step += field.type.size * field.count; // < 2^8 * 2^19
    }
  }

  const std::string& file_;
  const std::string& head_;
  std::size_t at_ = 0;
  Header header_;
};

// Numbers of the fields that are neither coordinates nor packed colour.
std::vector<std::size_t>
furtherFields(const Header& header, std::size_t most)
{
  std::vector<std::size_t> found;
  if (*header.height < 2)
    return found;
  for (std::size_t f = 0; f < header.fields.size() && found.size() < most; ++f) {
    const Field& field = header.fields[f];
    const Role role = roleOf(field.name);
    const bool place = role == Role::x || role == Role::y || role == Role::z;
    if (!place && role != Role::packed_color && field.name != "_" && field.count == 1)
      found.push_back(f);
  }
  return found;
}

// A further field that is kept, and which of the header's it is.
struct KeptField {
  std::size_t field;
  FrameField& to;
};

struct Reader {
  const std::string& file;
  Header header;
  std::vector<Role> roles;
  RawCloud cloud;
  std::vector<KeptField> kept;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> in{nullptr, &std::fclose};
  std::uint64_t bytes_left = 0; // of the file, behind the header

  std::string
  atByte(std::uint64_t offset) const
  {
    return "byte " + std::to_string(offset);
  }

  void
  read(void* to, std::uint64_t n)
  {
    if (std::fread(to, 1, n, in.get()) != n)
      throw LoadError(file, "", "cannot be read to its end");
  }

  void
  assignAll(std::uint64_t point, const std::uint8_t* bytes)
  {
    for (std::size_t f = 0; f < roles.size(); ++f)
      if (roles[f] != Role::none)
        assign(cloud.records[point],
               roles[f],
               header.fields[f].type,
               bytes + header.fields[f].offset);
    for (const KeptField& one : kept) {
      const Field& field = header.fields[one.field];
      one.to.values.push_back(number(field.type, bytes + field.offset));
    }
  }

  static float
  number(NumberType type, const std::uint8_t* bytes)
  {
    Record record;
    assign(record, Role::x, type, bytes);
    return record.x;
  }

  void
  readBinary()
  {
    const std::uint64_t points = *header.points;
    if (points > bytes_left / header.step)
      throw LoadError(file,
                      atByte(header.size),
                      "the header promises " + std::to_string(points) + " points of " +
                          std::to_string(header.step) + " bytes, only " +
                          std::to_string(bytes_left) + " bytes follow");
    cloud.records.resize(points);
    const std::uint64_t block =
        std::max<std::uint64_t>(1, (std::uint64_t(1) << 20) / header.step);
    std::vector<std::uint8_t> buffer(std::min(block, points) * header.step);
    for (std::uint64_t i = 0; i < points;) {
      const std::uint64_t n = std::min(block, points - i);
      read(buffer.data(), n * header.step);
      for (std::uint64_t k = 0; k < n; ++k)
        assignAll(i + k, &buffer[k * header.step]);
      i += n;
    }
  }

  void
  readCompressed()
  {
    const std::uint64_t points = *header.points;
    std::array<std::uint32_t, 2> sizes{};
    if (bytes_left < sizeof sizes)
      throw LoadError(file, atByte(header.size), "the compressed data's sizes are cut");
    read(sizes.data(), sizeof sizes);
    const std::uint64_t packed = sizes[0], unpacked = sizes[1];
    if (packed > bytes_left - sizeof sizes)
      throw LoadError(file,
                      atByte(header.size),
                      std::to_string(packed) + " compressed bytes are promised, only " +
                          std::to_string(bytes_left - sizeof sizes) + " follow");
    if (points > std::numeric_limits<std::uint32_t>::max() / header.step ||
        unpacked != points * header.step)
      throw LoadError(file,
                      atByte(header.size + 4),
                      "the uncompressed size " + std::to_string(unpacked) +
                          " is not that of " + std::to_string(points) + " points of " +
                          std::to_string(header.step) + " bytes");
    if (unpacked > lzf_ratio * packed)
      throw LoadError(file,
                      atByte(header.size),
                      std::to_string(packed) + " compressed bytes cannot hold " +
                          std::to_string(unpacked) + " bytes");
    // liblzf may read one code beyond its input
    std::vector<std::uint8_t> input(packed + 64), output(unpacked);
    read(input.data(), packed);
    if (pcl::lzfDecompress(input.data(),
                           static_cast<unsigned>(packed),
                           output.data(),
                           static_cast<unsigned>(unpacked)) != unpacked)
      throw LoadError(file, atByte(header.size + 8), "the compressed data is damaged");
    input = {};
    // field after field, each for all points
    cloud.records.resize(points);
    for (std::size_t f = 0; f < roles.size(); ++f) {
      const Field& field = header.fields[f];
      if (roles[f] == Role::none)
        continue;
      const std::uint8_t* column = output.data() + field.offset * points;
      const std::uint64_t size = field.type.size * field.count;
      for (std::uint64_t i = 0; i < points; ++i)
        assign(cloud.records[i], roles[f], field.type, column + i * size);
    }
    for (const KeptField& one : kept) {
      const Field& field = header.fields[one.field];
      const std::uint8_t* column = output.data() + field.offset * points;
      for (std::uint64_t i = 0; i < points; ++i)
        one.to.values.push_back(number(field.type, column + i * field.type.size));
    }
  }

  void
  readAscii()
  {
    const std::uint64_t points = *header.points;
    std::uint64_t columns = 0;
    for (const Field& field : header.fields)
      columns += field.count;
    // a digit and a separator each; the parser saw a field, of at least one number
    // NOLINTNEXTLINE(clang-analyzer-core.DivideZero)
    if (points > bytes_left / (2 * columns) + 1)
      throw LoadError(file,
                      std::to_string(header.lines),
                      "the header promises " + std::to_string(points) + " points of " +
                          std::to_string(columns) + " numbers, only " +
                          std::to_string(bytes_left) + " bytes follow");
    cloud.records.reserve(points);
    ChunkReader text(file, header.size);
    std::size_t line = header.lines;
    const char *p = nullptr, *end = nullptr;
    while (text.next(p, end))
      while (p < end) {
        ++line;
        const char* const stop =
            static_cast<const char*>(std::memchr(p, '\n', end - p));
        while (*p == ' ' || *p == '\t' || *p == '\r')
          ++p;
        if (p != stop) {
          if (cloud.records.size() == points)
            throw LoadError(file,
                            std::to_string(line),
                            "more than the " + std::to_string(points) +
                                " points that the header promises");
          cloud.records.emplace_back();
          parsePoint(cloud.records.back(), p, stop, line);
        }
        p = stop + 1;
      }
    if (cloud.records.size() != points)
      throw LoadError(file,
                      std::to_string(line),
                      "the header promises " + std::to_string(points) +
                          " points, the file holds " +
                          std::to_string(cloud.records.size()));
  }

  void
  parsePoint(Record& record, const char* p, const char* stop, std::size_t line)
  {
    std::array<std::uint8_t, 8> bytes{};
    for (std::size_t f = 0; f < roles.size(); ++f)
      for (std::uint64_t k = 0; k < header.fields[f].count; ++k) {
        const Field& field = header.fields[f];
        while (*p == ' ' || *p == '\t' || *p == '\r')
          ++p;
        const char* const token = p;
        while (!endsNumber(*p))
          ++p;
        // Colour written as a whole number is its bits, even in a field of type F: as
        // floats, packed colours are tiny, huge or no numbers.
        const bool bits = roles[f] == Role::packed_color &&
                          std::all_of(token, p, [](char c) { return isDigit(c); });
        const NumberType type = bits ? NumberType{'U', 4} : field.type;
        if (token == p || !textToBytes(token, type, bytes.data()))
          throw LoadError(
              file,
              std::to_string(line),
              "expected a number of type " + std::string(1, field.type.kind) +
                  std::to_string(field.type.size * 8) + " for " + shown(field.name) +
                  ", found " + shown(std::string(token, p)));
        if (k == 0)
          assign(record, roles[f], field.type, bytes.data());
        for (const KeptField& one : kept)
          if (one.field == f)
            one.to.values.push_back(number(type, bytes.data()));
      }
    while (*p == ' ' || *p == '\t' || *p == '\r')
      ++p;
    if (p != stop)
      throw LoadError(
          file, std::to_string(line), "more numbers than the header has fields");
  }
};

// Reads the points, and the further fields into \a further if it is not null.
RawCloud
readAll(const std::string& file,
        const LoadOptions& options,
        std::vector<FrameField>* further,
        std::size_t most)
{
  std::uint64_t size = 0;
  const std::string head = readHead(file, max_header, size);
  Reader reader{file, HeaderParser(file, head).parse(), {}, {}, {}};
  const Header& header = reader.header;
  if (*header.points > options.max_points)
    throw LoadError(file,
                    "",
                    std::to_string(*header.points) + " points are more than the " +
                        std::to_string(options.max_points) + " allowed");
  if (*header.points == 0)
    throw LoadError(file, "", "no points in it");
  for (const Field& field : header.fields) {
    Role role = roleOf(field.name);
    if (field.count != 1)
      role = Role::none;
    if (role == Role::packed_color && field.type.size != 4)
      throw LoadError(file, "", "field " + shown(field.name) + " must have 4 bytes");
    reader.roles.push_back(role);
  }
  checkRoles(file, reader.roles, reader.cloud);
  reader.cloud.width = *header.width;
  reader.cloud.height = *header.height;
  reader.cloud.format = "PCD " + header.data;
  const auto& pose = header.viewpoint;
  reader.cloud.origin = {pose[0], pose[1], pose[2]};
  reader.cloud.orientation = Eigen::Quaterniond(pose[3], pose[4], pose[5], pose[6]);

  if (further != nullptr) {
    const std::vector<std::size_t> found = furtherFields(header, most);
    if (found.empty())
      return {};
    for (const std::size_t f : found)
      further->push_back({header.fields[f].name, {}});
    for (std::size_t i = 0; i < found.size(); ++i)
      reader.kept.push_back({found[i], (*further)[i]});
  }
  reader.bytes_left = size - header.size;
  if (header.data == "ascii")
    reader.readAscii();
  else {
    reader.in.reset(std::fopen(file.c_str(), "rb"));
    if (!reader.in ||
        ::fseeko(reader.in.get(), static_cast<off_t>(header.size), SEEK_SET) != 0)
      throw LoadError(file, "", "cannot be read");
    if (header.data == "binary")
      reader.readBinary();
    else
      reader.readCompressed();
  }
  return std::move(reader.cloud);
}

} // namespace

RawCloud
readPcd(const std::string& file, const LoadOptions& options)
{
  return readAll(file, options, nullptr, 0);
}

std::vector<FrameField>
readPcdFields(const std::string& file, const LoadOptions& options, std::size_t most)
{
  std::vector<FrameField> fields;
  readAll(file, options, &fields, most);
  return fields;
}

} // namespace detail
} // namespace hoist
