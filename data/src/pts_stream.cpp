#include <hoist/data/pts_stream.h>

#include "chunk_reader.h"
#include "parse_number.h"
#include "pts_dialect.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace hoist {
namespace {

using detail::Column;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr std::size_t block_records = 16384;
constexpr int max_side = 1 << 15;
// Cells of a grid beyond what the file's records justify: a file of one line must not
// ask for gigabytes.
constexpr std::size_t free_cells = std::size_t(1) << 21;
constexpr std::size_t cells_per_record = 32;

bool
isSeparator(char c)
{
  return c == ' ' || c == '\t';
}

// A lone integer in the midst: the count of the next scan in a Leica file.
bool
isBlockCount(const char* p)
{
  while (isSeparator(*p))
    ++p;
  const char* const first = p;
  while (detail::isDigit(*p))
    ++p;
  if (p == first)
    return false;
  while (isSeparator(*p) || *p == '\r')
    ++p;
  return *p == '\n';
}

// Blank lines and comments hold no record.
bool
isRecord(const char* p)
{
  while (isSeparator(*p) || *p == '\r')
    ++p;
  return *p != '\n' && *p != '#' && !(p[0] == '/' && p[1] == '/');
}

// The usual camera size that holds the pixels, if one does closely.
std::pair<int, int>
cameraSize(int columns, int rows)
{
  static constexpr std::array<std::pair<int, int>, 13> usual = {{{160, 120},
                                                                 {320, 240},
                                                                 {400, 300},
                                                                 {512, 384},
                                                                 {640, 480},
                                                                 {800, 600},
                                                                 {960, 720},
                                                                 {1024, 768},
                                                                 {1280, 720},
                                                                 {1280, 960},
                                                                 {1600, 1200},
                                                                 {1920, 1080},
                                                                 {1920, 1440}}};
  for (const auto& [width, height] : usual)
    if (columns <= width && rows <= height && width <= 1.25 * columns &&
        height <= 1.25 * rows)
      return {width, height};
  return {columns, rows};
}

// The whole number that ends just before `stop`; `stop` moves to its start. Zero for
// anything else: bad numbers are reported when the line is read.
std::uint32_t
digitsBefore(const char* line, const char*& stop)
{
  while (stop > line && (isSeparator(stop[-1]) || stop[-1] == '\r'))
    --stop;
  std::uint64_t value = 0, place = 1;
  for (; stop > line && detail::isDigit(stop[-1]) && place < 10000000000; place *= 10)
    value += place * static_cast<unsigned>(*--stop - '0');
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(value, 0xffffffffu));
}

} // namespace

struct PTSStream::Impl {
  Impl(const std::string& name, const PTSOptions& wanted, std::size_t offset)
  : file(name), options(wanted), reader(name, offset)
  {
    open();
  }

  void open();

  void makeFields();

  void countLines();

  void chooseGrid(std::uint32_t max_u, std::uint32_t max_v);

  // Reads one line into `record`; returns the start of the next line.
  const char* parseLine(const char* p);

  [[noreturn]] void complain(const char* line) const;

  [[noreturn]] void
  fail(const std::string& reason) const
  {
    throw LoadError(file, std::to_string(line_number), reason);
  }

  std::string file;
  PTSOptions options;
  detail::ChunkReader reader;
  detail::Layout layout;
  PTSReport report;

  std::vector<pcl::PCLPointField> fields;
  std::vector<int> slot; // of each column, in units of 4 bytes
  std::size_t point_step = 0;
  int rgba_slot = -1, u_slot = -1, v_slot = -1, x_slot = 0, y_slot = 1, z_slot = 2;
  bool shifted = false;

  std::size_t max_records = 0;
  bool organized = false;
  int width = 0, height = 0;

  const char* at = nullptr;
  const char* end = nullptr;
  std::size_t line_number = 0;
  bool finished = false;
  std::array<std::uint32_t, 80> record{};
};

void
PTSStream::Impl::open()
{
  const char *begin = nullptr, *stop = nullptr;
  if (!reader.next(begin, stop))
    throw LoadError(file, "", "the file is empty");
  if (std::memchr(begin, '\0', stop - begin) != nullptr)
    throw LoadError(file, "", "holds zero bytes: this is no text");
  layout = detail::findLayout(file, begin, stop, options, report);
  shifted = options.offset != Eigen::Vector3d::Zero();
  makeFields();
  organized = options.organize && u_slot >= 0;
  reader.rewind();
  countLines();
  reader.rewind();
  line_number = 0;
}

void
PTSStream::Impl::makeFields()
{
  const auto add = [&](const std::string& name, std::uint8_t type) {
    pcl::PCLPointField field;
    field.name = name;
    field.offset = static_cast<std::uint32_t>(point_step);
    field.datatype = type;
    field.count = 1;
    fields.push_back(field);
    point_step += 4;
    return static_cast<int>(point_step / 4 - 1);
  };
  for (std::size_t i = 0; i < layout.columns.size(); ++i)
    switch (layout.columns[i]) {
    case Column::x:
      slot.push_back(x_slot = add("x", pcl::PCLPointField::FLOAT32));
      break;
    case Column::y:
      slot.push_back(y_slot = add("y", pcl::PCLPointField::FLOAT32));
      break;
    case Column::z:
      slot.push_back(z_slot = add("z", pcl::PCLPointField::FLOAT32));
      break;
    case Column::red:
    case Column::green:
    case Column::blue:
    case Column::alpha:
      if (rgba_slot < 0)
        rgba_slot = add("rgba", pcl::PCLPointField::UINT32);
      slot.push_back(rgba_slot);
      break;
    case Column::u:
      slot.push_back(u_slot = add("u", pcl::PCLPointField::UINT32));
      break;
    case Column::v:
      slot.push_back(v_slot = add("v", pcl::PCLPointField::UINT32));
      break;
    case Column::scalar:
      slot.push_back(add(layout.names[i], pcl::PCLPointField::FLOAT32));
      break;
    case Column::skip:
      slot.push_back(-1);
      break;
    }
}

void
PTSStream::Impl::countLines()
{
  const auto column_of = [&](Column c) {
    return std::find(layout.columns.begin(), layout.columns.end(), c) -
           layout.columns.begin();
  };
  const auto u_column = column_of(Column::u), v_column = column_of(Column::v);
  const auto last = std::max(u_column, v_column);
  // a Bumblebee's pixel stands last: found from the line's end
  const bool pixel_ends =
      last + 1 == static_cast<std::ptrdiff_t>(layout.columns.size()) &&
      std::abs(u_column - v_column) == 1;
  std::uint32_t max_u = 0, max_v = 0;
  const char *begin = nullptr, *stop = nullptr;
  std::size_t line = 0;
  while (reader.next(begin, stop))
    for (const char* p = begin; p < stop;) {
      const char* next = static_cast<const char*>(std::memchr(p, '\n', stop - p)) + 1;
      if (++line > layout.header_lines && isRecord(p)) {
        ++max_records;
        if (organized && pixel_ends) {
          const char* tail = next - 1;
          const std::uint32_t last_value = digitsBefore(p, tail);
          const std::uint32_t value = digitsBefore(p, tail);
          max_u = std::max(max_u, u_column > v_column ? last_value : value);
          max_v = std::max(max_v, u_column > v_column ? value : last_value);
        }
        else if (organized) {
          // bad numbers are reported when the line is read
          for (std::ptrdiff_t column = 0; column <= last; ++column) {
            while (isSeparator(*p))
              ++p;
            std::uint32_t value = 0;
            if ((column == u_column || column == v_column) &&
                detail::parseDigits(p, value) != nullptr)
              (column == u_column ? max_u : max_v) =
                  std::max(column == u_column ? max_u : max_v, value);
            while (!detail::endsNumber(*p))
              ++p;
          }
        }
      }
      p = next;
    }
  if (organized)
    chooseGrid(max_u, max_v);
}

void
PTSStream::Impl::chooseGrid(std::uint32_t max_u, std::uint32_t max_v)
{
  width = options.width;
  height = options.height;
  const std::string pixel =
      "(" + std::to_string(max_u) + ", " + std::to_string(max_v) + ")";
  if (width <= 0 || height <= 0) {
    if (max_u >= max_side || max_v >= max_side)
      throw LoadError(file, "", "pixel " + pixel + " lies on no camera's image");
    std::tie(width, height) =
        cameraSize(static_cast<int>(max_u) + 1, static_cast<int>(max_v) + 1);
    const std::size_t cells = static_cast<std::size_t>(width) * height;
    if (cells > std::max(free_cells, cells_per_record * max_records))
      throw LoadError(file,
                      "",
                      "pixel " + pixel + " asks for a far larger image than " +
                          std::to_string(max_records) + " records fill");
  }
  else if (max_u >= static_cast<std::uint32_t>(width) ||
           max_v >= static_cast<std::uint32_t>(height))
    throw LoadError(file,
                    "",
                    "pixel " + pixel + " lies outside the image of " +
                        std::to_string(width) + " x " + std::to_string(height));
}

void
PTSStream::Impl::complain(const char* line) const
{
  const char* stop = line;
  while (*stop != '\n')
    ++stop;
  std::size_t columns = 0;
  for (const char* p = line; p < stop;) {
    while (p < stop && (isSeparator(*p) || *p == '\r'))
      ++p;
    if (p == stop)
      break;
    const char* const token = p;
    while (!detail::endsNumber(*p) && p < stop)
      ++p;
    ++columns;
    if (columns > layout.columns.size())
      continue;
    const std::string text(token, p);
    double value = 0;
    const std::string padded = text + '\n';
    const char* after = detail::parseReal(padded.c_str(), value);
    const Column kind = layout.columns[columns - 1];
    const bool pixel = kind == Column::u || kind == Column::v;
    std::string shown = text.substr(0, 40);
    for (char& c : shown)
      if (static_cast<unsigned char>(c) < 32 || c == 127)
        c = '?';
    if (after == nullptr || *after != '\n')
      fail("expected a number in column " + std::to_string(columns) + ", found \"" +
           shown + '"');
    if (pixel && !(value >= 0 && value < 1e9 && value == std::floor(value)))
      fail("expected a pixel number in column " + std::to_string(columns) +
           ", found \"" + shown + '"');
  }
  fail("expected " + std::to_string(layout.columns.size()) + " columns, found " +
       std::to_string(columns));
}

const char*
PTSStream::Impl::parseLine(const char* p)
{
  const char* const line = p;
  std::uint32_t color = 0xff000000u;
  const std::size_t columns = layout.columns.size();
  for (std::size_t i = 0; i < columns; ++i) {
    while (isSeparator(*p))
      ++p;
    const Column kind = layout.columns[i];
    switch (kind) {
    case Column::x:
    case Column::y:
    case Column::z: {
      float value = 0;
      if (shifted) {
        double wide = 0;
        p = detail::parseReal(p, wide);
        value = static_cast<float>(wide - options.offset[static_cast<int>(kind)]);
      }
      else
        p = detail::parseReal(p, value);
      std::memcpy(&record[slot[i]], &value, 4);
      break;
    }
    case Column::scalar: {
      float value = 0;
      p = detail::parseReal(p, value);
      std::memcpy(&record[slot[i]], &value, 4);
      break;
    }
    case Column::red:
    case Column::green:
    case Column::blue:
    case Column::alpha: {
      std::uint32_t value = 0;
      const char* after = report.unit_colors ? nullptr : detail::parseDigits(p, value);
      if (after == nullptr) { // a fraction, a sign or an exponent
        float wide = 0;
        after = detail::parseReal(p, wide);
        const float scaled = report.unit_colors ? wide * 255.0f : wide;
        // a colour that is no number is black
        value = scaled > 0
                    ? static_cast<std::uint32_t>(std::lround(std::min(scaled, 255.0f)))
                    : 0;
      }
      p = after;
      value = std::min(value, 255u);
      if (kind == Column::alpha)
        color = (color & 0x00ffffffu) | value << 24;
      else
        color |= value << (kind == Column::red ? 16 : kind == Column::green ? 8 : 0);
      break;
    }
    case Column::u:
    case Column::v:
      p = detail::parseDigits(p, record[slot[i]]);
      break;
    case Column::skip: {
      double ignored = 0;
      p = detail::parseReal(p, ignored);
      break;
    }
    }
    if (p == nullptr || !detail::endsNumber(*p))
      complain(line);
  }
  if (rgba_slot >= 0)
    record[rgba_slot] = color;
  while (isSeparator(*p) || *p == '\r')
    ++p;
  if (*p != '\n')
    complain(line);
  return p + 1;
}

PTSStream::PTSStream(const std::string& file,
                     const PTSOptions& options,
                     std::size_t byte_offset)
: impl_(std::make_unique<Impl>(file, options, byte_offset))
{
}

PTSStream::~PTSStream() = default;

const std::vector<pcl::PCLPointField>&
PTSStream::fields() const
{
  return impl_->fields;
}

std::size_t
PTSStream::pointStep() const
{
  return impl_->point_step;
}

std::size_t
PTSStream::maxRecords() const
{
  return impl_->max_records;
}

bool
PTSStream::organized() const
{
  return impl_->organized;
}

int
PTSStream::width() const
{
  return impl_->width;
}

int
PTSStream::height() const
{
  return impl_->height;
}

const PTSReport&
PTSStream::report() const
{
  return impl_->report;
}

PTSReport&
PTSStream::report()
{
  return impl_->report;
}

std::size_t
PTSStream::next(std::vector<std::uint8_t>& block)
{
  Impl& m = *impl_;
  const std::size_t step = m.point_step;
  block.resize(block_records * step);
  std::size_t n = 0;
  while (n < block_records) {
    if (m.at == m.end) {
      if (!m.reader.next(m.at, m.end)) {
        m.at = m.end = nullptr;
        break;
      }
      continue;
    }
    ++m.line_number;
    if (m.line_number <= m.layout.header_lines || !isRecord(m.at) ||
        (m.layout.columns.size() > 1 && isBlockCount(m.at))) {
      m.at = static_cast<const char*>(std::memchr(m.at, '\n', m.end - m.at)) + 1;
      continue;
    }
    m.at = m.parseLine(m.at);
    ++m.report.records;
    if (m.organized && (m.record[m.u_slot] >= static_cast<std::uint32_t>(m.width) ||
                        m.record[m.v_slot] >= static_cast<std::uint32_t>(m.height)))
      m.fail("a pixel that was not there before: the file changed while it was read");
    float xyz[3];
    std::memcpy(&xyz[0], &m.record[m.x_slot], 4);
    std::memcpy(&xyz[1], &m.record[m.y_slot], 4);
    std::memcpy(&xyz[2], &m.record[m.z_slot], 4);
    // stereo software writes z = 0 where it found no match; only there z is a depth
    const bool measured = std::isfinite(xyz[0]) && std::isfinite(xyz[1]) &&
                          std::isfinite(xyz[2]) && (m.u_slot < 0 || xyz[2] > 0);
    if (!measured) {
      ++m.report.without_depth;
      if (!m.organized)
        continue;
      for (const int s : {m.x_slot, m.y_slot, m.z_slot})
        std::memcpy(&m.record[s], &nan, 4);
    }
    std::memcpy(&block[n * step], m.record.data(), step);
    ++n;
  }
  block.resize(n * step);
  if (n == 0 && !m.finished) {
    m.finished = true;
    if (m.report.declared && *m.report.declared != m.report.records)
      m.report.warnings.push_back(
          "the count line says " + std::to_string(*m.report.declared) +
          " points, the file holds " + std::to_string(m.report.records));
  }
  return n;
}

void
PTSStream::blankRow(int row, std::vector<std::uint8_t>& block) const
{
  const Impl& m = *impl_;
  std::vector<std::uint32_t> blank(m.point_step / 4, 0);
  for (const int s : {m.x_slot, m.y_slot, m.z_slot})
    std::memcpy(&blank[s], &nan, 4);
  if (m.rgba_slot >= 0)
    blank[m.rgba_slot] = 0xff000000u;
  blank[m.v_slot] = static_cast<std::uint32_t>(row);
  block.resize(m.point_step * m.width);
  for (int u = 0; u < m.width; ++u) {
    blank[m.u_slot] = static_cast<std::uint32_t>(u);
    std::memcpy(&block[u * m.point_step], blank.data(), m.point_step);
  }
}

void
PTSStream::pixelOf(const std::uint8_t* record, int& u, int& v, float& z) const
{
  const Impl& m = *impl_;
  std::uint32_t column = 0, row = 0;
  std::memcpy(&column, record + 4 * m.u_slot, 4);
  std::memcpy(&row, record + 4 * m.v_slot, 4);
  std::memcpy(&z, record + 4 * m.z_slot, 4);
  u = static_cast<int>(column);
  v = static_cast<int>(row);
}

} // namespace hoist
