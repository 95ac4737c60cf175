#include "pts_dialect.h"

#include "parse_number.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>

namespace hoist {
namespace detail {
namespace {

constexpr std::size_t max_columns = 64;
constexpr std::size_t sample_lines = 2000;

using Tokens = std::vector<std::string>;

// Splits a line at spaces and tabs. Stops at max_columns + 1.
Tokens
split(const char* begin, const char* end)
{
  Tokens tokens;
  const auto space = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (tokens.size() <= max_columns) {
    while (begin < end && space(*begin))
      ++begin;
    if (begin == end)
      break;
    const char* stop = begin;
    while (stop < end && !space(*stop))
      ++stop;
    tokens.emplace_back(begin, stop);
    begin = stop;
  }
  return tokens;
}

std::string
lower(std::string text)
{
  for (char& c : text)
    if (c >= 'A' && c <= 'Z')
      c = static_cast<char>(c - 'A' + 'a');
  return text;
}

bool
isNumber(const std::string& token)
{
  double value = 0;
  const std::string text = token + '\n';
  const char* stop = parseReal(text.c_str(), value);
  return stop != nullptr && *stop == '\n';
}

double
number(const std::string& token)
{
  double value = 0;
  (void)parseReal((token + '\n').c_str(), value);
  return value;
}

bool
isWhole(const std::string& token)
{
  return !token.empty() && std::all_of(token.begin(), token.end(), isDigit);
}

bool
isByte(const std::string& token)
{
  return isWhole(token) && token.size() <= 3 && number(token) <= 255;
}

// For error messages: text of a hostile file must not reach the terminal as it is.
std::string
quoted(std::string text)
{
  if (text.size() > 40)
    text = text.substr(0, 40) + "...";
  for (char& c : text)
    if (std::iscntrl(static_cast<unsigned char>(c)) != 0)
      c = '?';
  return '"' + text + '"';
}

struct Named {
  Column column;
  std::string field;
};

Named
columnByName(const std::string& name)
{
  const std::string n = lower(name);
  if (n == "x" || n == "y" || n == "z")
    return {n == "x" ? Column::x : n == "y" ? Column::y : Column::z, n};
  if (n == "r" || n == "rf" || n == "red")
    return {Column::red, "rgba"};
  if (n == "g" || n == "gf" || n == "green")
    return {Column::green, "rgba"};
  if (n == "b" || n == "bf" || n == "blue")
    return {Column::blue, "rgba"};
  if (n == "a" || n == "alpha")
    return {Column::alpha, "rgba"};
  if (n == "u" || n == "col" || n == "column")
    return {Column::u, "u"};
  if (n == "v" || n == "row")
    return {Column::v, "v"};
  if (n == "i" || n == "intensity")
    return {Column::scalar, "intensity"};
  if (n == "nx" || n == "ny" || n == "nz")
    return {Column::scalar, "normal_" + n.substr(1)};
  if (n == "_")
    return {Column::skip, ""};
  return {Column::scalar, name};
}

void
take(Layout& layout, PTSReport& report, const Tokens& names)
{
  for (const std::string& name : names) {
    const Named named = columnByName(name);
    layout.columns.push_back(named.column);
    layout.names.push_back(named.field);
  }
  report.fields = names;
}

// Whether the two columns run over the image as a camera's memory does.
bool
scansImage(const std::vector<Tokens>& sample, std::size_t row, std::size_t col)
{
  double last_row = -1, last_col = -1;
  for (const Tokens& line : sample) {
    const double r = number(line[row]), c = number(line[col]);
    if (r < last_row || (r == last_row && c <= last_col))
      return false;
    last_row = r;
    last_col = c;
  }
  return true;
}

bool
allOf(const std::vector<Tokens>& sample,
      std::size_t from,
      std::size_t to,
      bool (*predicate)(const std::string&))
{
  for (const Tokens& line : sample)
    for (std::size_t i = from; i < to; ++i)
      if (!predicate(line[i]))
        return false;
  return true;
}

// The meaning of columns that nobody names.
Tokens
detect(const std::string& file,
       const std::vector<Tokens>& sample,
       std::size_t first_line,
       PTSReport& report)
{
  const std::size_t n = sample.front().size();
  switch (n) {
  case 3:
    report.dialect = "XYZ";
    return {"x", "y", "z"};
  case 4:
    report.dialect = "XYZI";
    return {"x", "y", "z", "i"};
  case 6:
    report.dialect = "XYZRGB";
    return {"x", "y", "z", "r", "g", "b"};
  case 7:
    report.dialect = "XYZIRGB";
    return {"x", "y", "z", "i", "r", "g", "b"};
  case 8:
    if (!report.declared && allOf(sample, 3, 8, isWhole)) {
      if (allOf(sample, 3, 6, isByte) && scansImage(sample, 6, 7)) {
        report.dialect = "Bumblebee";
        return {"x", "y", "z", "r", "g", "b", "row", "col"};
      }
      if (allOf(sample, 5, 8, isByte) && scansImage(sample, 4, 3)) {
        report.dialect = "x y z u v R G B";
        return {"x", "y", "z", "u", "v", "r", "g", "b"};
      }
    }
    throw LoadError(file,
                    std::to_string(first_line),
                    "8 columns, but they are no Bumblebee records (x y z R G B row "
                    "col, the pixels in the image's order, no count line); give a "
                    "field list");
  default:
    break;
  }
  throw LoadError(file,
                  std::to_string(first_line),
                  "expected 3, 4, 6, 7 or 8 columns or a line that names them, found " +
                      (n > max_columns ? "more than " + std::to_string(max_columns)
                                       : std::to_string(n)) +
                      "; give a field list");
}

bool
hasAll(const Layout& layout, std::initializer_list<Column> wanted)
{
  return std::all_of(wanted.begin(), wanted.end(), [&](Column c) {
    return std::count(layout.columns.begin(), layout.columns.end(), c) == 1;
  });
}

bool
hasAny(const Layout& layout, std::initializer_list<Column> wanted)
{
  return std::any_of(wanted.begin(), wanted.end(), [&](Column c) {
    return std::count(layout.columns.begin(), layout.columns.end(), c) > 0;
  });
}

void
check(const std::string& file, const Layout& layout)
{
  const auto fail = [&](const char* reason) { throw LoadError(file, "", reason); };
  if (!hasAll(layout, {Column::x, Column::y, Column::z}))
    fail("the field list must name x, y and z once each");
  if (hasAny(layout, {Column::red, Column::green, Column::blue, Column::alpha}) &&
      !hasAll(layout, {Column::red, Column::green, Column::blue}))
    fail("the field list must name r, g and b once each, or none of them");
  if (hasAny(layout, {Column::u, Column::v}) && !hasAll(layout, {Column::u, Column::v}))
    fail("the field list must name u and v once each, or neither");
  for (std::size_t i = 0; i < layout.names.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (layout.names[i] == layout.names[k] && layout.columns[i] == Column::scalar)
        fail("two columns have the same name");
  if (layout.columns.size() > max_columns)
    fail("the field list names more than 64 columns");
}

} // namespace

Layout
findLayout(const std::string& file,
           const char* begin,
           const char* end,
           const PTSOptions& options,
           PTSReport& report)
{
  Layout layout;
  const bool given = !options.fields.empty();
  if (given) {
    take(layout,
         report,
         split(options.fields.data(), options.fields.data() + options.fields.size()));
    report.dialect = "given";
    check(file, layout);
  }

  std::vector<Tokens> sample;
  Tokens header;
  std::size_t line_number = 0;
  for (; begin < end && sample.size() < sample_lines;) {
    const char* stop = static_cast<const char*>(std::memchr(begin, '\n', end - begin));
    ++line_number;
    const char* line = begin;
    begin = stop + 1;
    const bool comment = line[0] == '#' || (line[0] == '/' && line[1] == '/');
    if (comment)
      line += line[0] == '#' ? 1 : 2;
    Tokens tokens = split(line, stop);
    if (tokens.empty()) {
      if (sample.empty())
        layout.header_lines = line_number;
      continue;
    }
    if (sample.empty()) {
      if (lower(tokens[0]) == "version:")
        throw LoadError(file,
                        std::to_string(line_number),
                        "this is a list of face landmarks (version:, n_points:), not "
                        "a point cloud");
      const bool names = lower(tokens[0]) == "x" && !isNumber(tokens[0]);
      if (comment || names) {
        if (names && header.empty())
          header = tokens;
        layout.header_lines = line_number;
        continue;
      }
      if (tokens.size() == 1 && isWhole(tokens[0]) && !report.declared) {
        if (tokens[0].size() > 18)
          throw LoadError(
              file, std::to_string(line_number), "the count of points is absurd");
        report.declared = static_cast<std::size_t>(number(tokens[0]));
        layout.header_lines = line_number;
        continue;
      }
    }
    const bool block_count = tokens.size() == 1 && isWhole(tokens[0]);
    if (comment || (block_count && !sample.empty()))
      continue;
    for (const std::string& token : tokens)
      if (!isNumber(token))
        throw LoadError(file,
                        std::to_string(line_number),
                        "expected a number, found " + quoted(token));
    // a line of another length is reported with its number when it is read
    if (sample.empty() || tokens.size() == sample.front().size())
      sample.push_back(std::move(tokens));
  }

  if (sample.empty()) {
    if (report.declared && *report.declared == 0) {
      if (!given)
        take(layout, report, {"x", "y", "z"});
      report.dialect = given ? "given" : "XYZ";
      return layout;
    }
    throw LoadError(file, "", "no points in it");
  }
  const std::size_t first_line = layout.header_lines + 1;
  if (!given) {
    if (!header.empty()) {
      take(layout, report, header);
      report.dialect = "header";
    }
    else
      take(layout, report, detect(file, sample, first_line, report));
    check(file, layout);
  }
  if (layout.columns.size() != sample.front().size())
    throw LoadError(file,
                    std::to_string(first_line),
                    "expected " + std::to_string(layout.columns.size()) +
                        " columns, found " + std::to_string(sample.front().size()));

  // Colours from 0 to 1 have a point and never exceed 1.
  bool fraction = false;
  double largest = 0;
  for (const Tokens& line : sample)
    for (std::size_t i = 0; i < line.size(); ++i)
      if (layout.columns[i] == Column::red || layout.columns[i] == Column::green ||
          layout.columns[i] == Column::blue || layout.columns[i] == Column::alpha) {
        fraction |= line[i].find('.') != std::string::npos;
        largest = std::max(largest, number(line[i]));
      }
  report.unit_colors = fraction && largest <= 1.0;
  return layout;
}

} // namespace detail
} // namespace hoist
