// PLY, ascii and binary of both byte orders. The grid's size comes from "obj_info
// num_cols" and "num_rows" or from a camera element's viewport, as PCL writes them.
#include "chunk_reader.h"
#include "header_text.h"
#include "parse_number.h"
#include "raw_cloud.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <optional>

namespace hoist {
namespace detail {
namespace {

constexpr std::size_t max_header = std::size_t(1) << 16;
constexpr std::size_t max_properties = 256;
constexpr std::size_t max_elements = 32;

struct Property {
  std::string name;
  NumberType type;
  std::uint64_t offset = 0;
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
  std::uint64_t step = 0;
  bool has_list = false; // no fixed size
};

struct Header {
  enum class Format { ascii, little, big };
  Format format = Format::ascii;
  std::string format_name;
  std::vector<Element> elements;
  std::optional<std::uint64_t> columns, rows;
  std::size_t size = 0;
  std::size_t lines = 0;
};

std::optional<NumberType>
typeOf(const std::string& name)
{
  static const std::map<std::string, NumberType> table = {
      {"char", {'I', 1}},
      {"int8", {'I', 1}},
      {"uchar", {'U', 1}},
      {"uint8", {'U', 1}},
      {"short", {'I', 2}},
      {"int16", {'I', 2}},
      {"ushort", {'U', 2}},
      {"uint16", {'U', 2}},
      {"int", {'I', 4}},
      {"int32", {'I', 4}},
      {"uint", {'U', 4}},
      {"uint32", {'U', 4}},
      {"float", {'F', 4}},
      {"float32", {'F', 4}},
      {"double", {'F', 8}},
      {"float64", {'F', 8}},
  };
  const auto found = table.find(name);
  return found == table.end() ? std::nullopt : std::optional(found->second);
}

constexpr std::size_t max_words = 8; // of a header line; no valid one has more

class HeaderParser {
public:
  HeaderParser(const std::string& file, const std::string& head)
  : file_(file), head_(head)
  {
  }

  Header
  parse()
  {
    while (!done_) {
      const std::size_t stop = head_.find('\n', at_);
      if (stop == std::string::npos)
        throw LoadError(file_,
                        "",
                        head_.size() >= max_header
                            ? "no end_header in its first " +
                                  std::to_string(max_header) + " bytes"
                            : "the header ends before end_header");
      ++header_.lines;
      parseLine(split(head_.substr(at_, stop - at_), max_words));
      at_ = stop + 1;
    }
    header_.size = at_;
    if (header_.format_name.empty())
      fail("the header has no format line");
    return header_;
  }

private:
  [[noreturn]] void
  fail(const std::string& reason) const
  {
    throw LoadError(file_, std::to_string(header_.lines), reason);
  }

  std::uint64_t
  whole(const std::string& text) const
  {
    std::uint64_t value = 0;
    const auto [stop, error] =
        std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || stop != text.data() + text.size())
      fail("expected a whole number, found " + shown(text));
    return value;
  }

  void
  parseLine(const std::vector<std::string>& words)
  {
    if (header_.lines == 1) {
      if (words.size() != 1 || words[0] != "ply")
        fail("expected \"ply\" in the first line");
      return;
    }
    if (words.empty() || words[0] == "comment")
      return;
    if (words[0] == "obj_info") {
      if (words.size() == 3 && words[1] == "num_cols")
        header_.columns = whole(words[2]);
      if (words.size() == 3 && words[1] == "num_rows")
        header_.rows = whole(words[2]);
    }
    else if (words[0] == "format") {
      if (words.size() != 3 || words[2] != "1.0")
        fail("expected a format line of PLY 1.0");
      if (words[1] == "ascii")
        header_.format = Header::Format::ascii;
      else if (words[1] == "binary_little_endian")
        header_.format = Header::Format::little;
      else if (words[1] == "binary_big_endian")
        header_.format = Header::Format::big;
      else
        fail("expected ascii, binary_little_endian or binary_big_endian, found " +
             shown(words[1]));
      header_.format_name = words[1];
    }
    else if (words[0] == "element") {
      if (words.size() != 3 || header_.elements.size() == max_elements)
        fail("expected a name and a count after element");
      Element element;
      element.name = words[1];
      element.count = whole(words[2]);
      header_.elements.push_back(element);
    }
    else if (words[0] == "property")
      parseProperty(words);
    else if (words[0] == "end_header")
      done_ = true;
    else
      fail("expected a line of a PLY header, found " + shown(words[0]));
  }

  void
  parseProperty(const std::vector<std::string>& words)
  {
    if (header_.elements.empty())
      fail("a property before the first element");
    Element& element = header_.elements.back();
    if (words.size() == 5 && words[1] == "list") {
      element.has_list = true;
      return;
    }
    const auto type =
        words.size() == 3 ? typeOf(words[1]) : std::optional<NumberType>();
    if (!type)
      fail("expected a number type and a name after property");
    if (element.properties.size() == max_properties)
      fail("more than " + std::to_string(max_properties) + " properties");
    element.properties.push_back({words[2], *type, element.step});
    element.step += type->size;
  }

  const std::string& file_;
  const std::string& head_;
  std::size_t at_ = 0;
  bool done_ = false;
  Header header_;
};

// The body as a sequence of numbers, text or bytes.
class Body {
public:
  Body(const std::string& file, const Header& header)
  : file_(file), header_(header), line_(header.lines)
  {
    if (header.format == Header::Format::ascii)
      text_ = std::make_unique<ChunkReader>(file, header.size);
    else {
      in_.reset(std::fopen(file.c_str(), "rb"));
      if (!in_ || ::fseeko(in_.get(), static_cast<off_t>(header.size), SEEK_SET) != 0)
        throw LoadError(file, "", "cannot be read");
    }
  }

  /** \brief Reads one item of the element: its bytes in this machine's order. */
  void
  next(const Element& element, std::vector<std::uint8_t>& bytes)
  {
    bytes.resize(element.step);
    if (text_)
      nextLine(element, bytes);
    else {
      if (std::fread(bytes.data(), 1, element.step, in_.get()) != element.step)
        throw LoadError(
            file_, "", "ends in the midst of its " + element.name + " data");
      if (header_.format == Header::Format::big)
        for (const Property& p : element.properties)
          std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(p.offset),
                       bytes.begin() + static_cast<std::ptrdiff_t>(p.offset) +
                           p.type.size);
    }
  }

private:
  void
  nextLine(const Element& element, std::vector<std::uint8_t>& bytes)
  {
    for (;;) {
      while (at_ == end_)
        if (!text_->next(at_, end_))
          throw LoadError(file_,
                          std::to_string(line_),
                          "ends in the midst of its " + element.name + " data");
      ++line_;
      const char* p = at_;
      const char* const stop = static_cast<const char*>(std::memchr(p, '\n', end_ - p));
      at_ = stop + 1;
      skip(p);
      if (p == stop)
        continue;
      for (const Property& property : element.properties) {
        const char* const token = p;
        while (!endsNumber(*p))
          ++p;
        if (token == p || !textToBytes(token, property.type, &bytes[property.offset]))
          throw LoadError(file_,
                          std::to_string(line_),
                          "expected a number for " + shown(property.name) + ", found " +
                              shown(std::string(token, p)));
        skip(p);
      }
      if (p != stop)
        throw LoadError(file_,
                        std::to_string(line_),
                        "more numbers than the element has properties");
      return;
    }
  }

  static void
  skip(const char*& p)
  {
    while (*p == ' ' || *p == '\t' || *p == '\r')
      ++p;
  }

  const std::string& file_;
  const Header& header_;
  std::unique_ptr<ChunkReader> text_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> in_{nullptr, &std::fclose};
  const char* at_ = nullptr;
  const char* end_ = nullptr;
  std::size_t line_;
};

// PCL's camera element: pose and viewport.
void
readCamera(const Element& element,
           const std::vector<std::uint8_t>& bytes,
           Header& header,
           RawCloud& cloud)
{
  std::map<std::string, double> values;
  for (const Property& p : element.properties) {
    Record number; // through x: any type becomes a float
    assign(number, Role::x, p.type, &bytes[p.offset]);
    values[p.name] = number.x;
  }
  const auto has = [&](std::initializer_list<const char*> names) {
    return std::all_of(
        names.begin(), names.end(), [&](const char* n) { return values.count(n) > 0; });
  };
  if (has({"viewportx", "viewporty"}) && !header.columns && values["viewportx"] >= 1 &&
      values["viewporty"] >= 1 && values["viewportx"] < 1e6 &&
      values["viewporty"] < 1e6) {
    header.columns = static_cast<std::uint64_t>(values["viewportx"]);
    header.rows = static_cast<std::uint64_t>(values["viewporty"]);
  }
  if (has({"view_px", "view_py", "view_pz"}))
    cloud.origin = {values["view_px"], values["view_py"], values["view_pz"]};
  if (has({"x_axisx",
           "x_axisy",
           "x_axisz",
           "y_axisx",
           "y_axisy",
           "y_axisz",
           "z_axisx",
           "z_axisy",
           "z_axisz"})) {
    Eigen::Matrix3d axes; // PCL writes the rotation row by row under these names
    axes << values["x_axisx"], values["x_axisy"], values["x_axisz"], values["y_axisx"],
        values["y_axisy"], values["y_axisz"], values["z_axisx"], values["z_axisy"],
        values["z_axisz"];
    if (axes.allFinite() && (axes * axes.transpose()).isIdentity(1e-3) &&
        axes.determinant() > 0)
      cloud.orientation = Eigen::Quaterniond(axes);
    else
      cloud.warnings.emplace_back("the camera element's axes are no rotation");
  }
}

} // namespace

RawCloud
readPly(const std::string& file, const LoadOptions& options)
{
  std::uint64_t size = 0;
  const std::string head = readHead(file, max_header, size);
  Header header = HeaderParser(file, head).parse();
  RawCloud cloud;
  cloud.format = "PLY " + header.format_name;

  const auto vertex = std::find_if(header.elements.begin(),
                                   header.elements.end(),
                                   [](const Element& e) { return e.name == "vertex"; });
  if (vertex == header.elements.end() || vertex->count == 0)
    throw LoadError(file, "", "no points in it");
  if (vertex->has_list)
    throw LoadError(file, "", "its vertices have lists, which no point has");
  std::vector<Role> roles;
  for (const Property& p : vertex->properties) {
    Role role = roleOf(p.name);
    if (role == Role::packed_color && p.type.size != 4)
      role = Role::none;
    roles.push_back(role);
  }
  checkRoles(file, roles, cloud);
  const std::uint64_t points = vertex->count;
  if (points > options.max_points)
    throw LoadError(file,
                    "",
                    std::to_string(points) + " points are more than the " +
                        std::to_string(options.max_points) + " allowed");
  // text: a digit and a separator each
  const bool ascii = header.format == Header::Format::ascii;
  const std::uint64_t least = ascii ? 2 * roles.size() : vertex->step;
  if (points > (size - header.size) / least + 1)
    throw LoadError(file,
                    std::to_string(header.lines),
                    "the header promises " + std::to_string(points) + " points, only " +
                        std::to_string(size - header.size) + " bytes follow");

  Body body(file, header);
  std::vector<std::uint8_t> bytes;
  for (auto element = header.elements.begin(); element != header.elements.end();
       ++element) {
    if (element->count == 0)
      continue;
    const bool camera = element->name == "camera" && !element->has_list;
    if (element > vertex && !camera)
      break; // faces and the like: nothing of a frame follows
    if (element->has_list)
      throw LoadError(
          file, "", "its element " + shown(element->name) + " comes before the points");
    // items without properties take no bytes: millions of them would be read for ever
    if (element->step == 0)
      continue;
    if (element == vertex)
      cloud.records.reserve(points);
    for (std::uint64_t i = 0; i < element->count; ++i) {
      body.next(*element, bytes);
      if (element == vertex) {
        cloud.records.emplace_back();
        for (std::size_t f = 0; f < roles.size(); ++f)
          assign(cloud.records.back(),
                 roles[f],
                 element->properties[f].type,
                 &bytes[element->properties[f].offset]);
      }
      else if (camera && i == 0)
        readCamera(*element, bytes, header, cloud);
    }
  }
  cloud.width = points;
  cloud.height = 1;
  if (header.columns && header.rows && *header.columns <= points &&
      *header.rows <= points && *header.columns * *header.rows == points) {
    cloud.width = *header.columns;
    cloud.height = *header.rows;
  }
  return cloud;
}

} // namespace detail
} // namespace hoist
