#include "part21_scanner.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <limits>
#include <utility>

namespace hoist {
namespace {

using part21::Scanner;

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
const char* const magic = "ISO-10303-21";

// Passes "NAME = list ;" or "= ( NAME list NAME list ) ;" and says the name.
std::string_view
passBody(Scanner& scan)
{
  std::string_view name;
  if (scan.peek() == '(') {
    Scanner inside = scan; // of a complex instance: names, not arguments
    inside.skip();
    inside.skipSpace();
    if (inside.takeName().empty())
      inside.expected("the name of an entity");
  }
  else {
    name = scan.takeName();
    if (name.empty())
      scan.expected("the name of an entity");
    scan.skipSpace();
    if (scan.peek() != '(')
      scan.expected("\"(\" behind the name of an entity");
  }
  scan.passList();
  return name;
}

struct FileCloser {
  void
  operator()(std::FILE* file) const
  {
    std::fclose(file);
  }
};

} // namespace

std::string_view
Part21Value::word() const
{
  if (kind == Kind::enumeration)
    return raw.substr(1, raw.size() - 2);
  if (kind != Kind::typed)
    return {};
  std::size_t end = 0;
  while (end < raw.size() && raw[end] != '(' && raw[end] != ' ' && raw[end] != '\n' &&
         raw[end] != '\r' && raw[end] != '\t' && raw[end] != '/')
    ++end;
  return raw.substr(0, end);
}

std::string
Part21Value::text() const
{
  return kind == Kind::text ? decodePart21(raw) : std::string();
}

Part21File
Part21File::read(const std::filesystem::path& path, std::uintmax_t max_bytes)
{
  const std::string name = path.string();
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    throw LoadError(name, "", "is a folder");
  const std::unique_ptr<std::FILE, FileCloser> file(std::fopen(path.c_str(), "rbe"));
  if (!file)
    throw LoadError(name, "", std::string("cannot be read: ") + std::strerror(errno));
  // a gigabyte of something else is refused by its first bytes
  std::string bytes(4096, '\0');
  bytes.resize(std::fread(bytes.data(), 1, bytes.size(), file.get()));
  if (bytes.compare(0, 4, "PK\x03\x04") == 0)
    throw LoadError(
        name, "", "is a zip archive (.ifcZIP?): unpack it and name the .ifc");
  if (bytes.find("<?xml") != std::string::npos &&
      bytes.find(magic) == std::string::npos)
    throw LoadError(name, "", "is XML (ifcXML?): only STEP files (.ifc) are read");
  const std::size_t bom = bytes.compare(0, 3, "\xef\xbb\xbf") == 0 ? 3 : 0;
  const std::size_t first = bytes.find_first_not_of(" \t\r\n", bom);
  // a comment may be longer than what was read so far
  if (first != std::string::npos && bytes[first] != '/' &&
      bytes.compare(first, std::strlen(magic), magic) != 0)
    Scanner(bytes, name, first).expected("\"ISO-10303-21;\"");
  if (const auto size = std::filesystem::file_size(path, error);
      !error && size > max_bytes)
    throw LoadError(name,
                    "",
                    "has " + std::to_string(size) + " bytes, more than the " +
                        std::to_string(max_bytes) + " that are read");
  else if (!error)
    bytes.reserve(size);
  for (;;) {
    constexpr std::size_t step = std::size_t(1) << 22;
    const std::size_t had = bytes.size();
    bytes.resize(had + step);
    const std::size_t got = std::fread(&bytes[had], 1, step, file.get());
    bytes.resize(had + got);
    if (bytes.size() > max_bytes)
      throw LoadError(
          name, "", "has more than " + std::to_string(max_bytes) + " bytes");
    if (got == 0)
      break;
  }
  if (std::ferror(file.get()) != 0)
    throw LoadError(name, "", "cannot be read");
  return parse(std::move(bytes), name);
}

Part21File
Part21File::parse(std::string bytes, const std::string& name)
{
  Part21File file;
  file.bytes_ = std::make_shared<const std::string>(std::move(bytes));
  file.name_ = name;
  file.index();
  file.indexIds();
  return file;
}

void
Part21File::index()
{
  Scanner scan(*bytes_, name_);
  if (bytes_->compare(0, 3, "\xef\xbb\xbf") == 0)
    scan.skip(3);
  const auto line = [&](const char* word) {
    scan.skipSpace();
    const std::size_t at = scan.at();
    if (!scan.take(word))
      scan.expected(std::string("\"") + word + ";\"");
    scan.skipSpace();
    scan.expect(';', (std::string("behind ") + word).c_str());
    return at;
  };
  line(magic);
  line("HEADER");
  for (scan.skipSpace(); !scan.take("ENDSEC"); scan.skipSpace()) {
    Part21Record record;
    record.name = scan.takeName();
    if (record.name.empty())
      scan.expected("a line of the header or \"ENDSEC;\"");
    scan.skipSpace();
    record.arguments = scan.items(0);
    scan.skipSpace();
    scan.expect(';', "behind a line of the header");
    header_.push_back(std::move(record));
  }
  scan.skipSpace();
  scan.expect(';', "behind ENDSEC");
  scan.skipSpace();
  if (scan.peek() == 'A' || scan.peek() == 'R' || scan.peek() == 'S')
    scan.expected("\"DATA;\" (sections of edition 3 are not read)");
  line("DATA");

  names_.emplace_back();
  by_name_.emplace_back();
  std::string last_name;
  std::uint32_t last_number = 0;
  for (scan.skipSpace(); scan.peek() == '#'; scan.skipSpace()) {
    Part21Instance instance;
    instance.begin = scan.at();
    scan.skip();
    instance.id = scan.takeId();
    scan.skipSpace();
    scan.expect('=', "behind the id of an instance");
    scan.skipSpace();
    instance.body = scan.at();
    const std::string_view name = passBody(scan);
    scan.skipSpace();
    scan.expect(';', "behind an instance");
    instance.end = scan.at();
    if (instances_.size() >= none)
      fail(instance.begin, "more than 2^32 instances");
    if (name != last_name) {
      last_name = name;
      const auto [entry, is_new] =
          name_numbers_.emplace(part21::upperCase(name), names_.size());
      if (name.empty())
        entry->second = 0;
      else if (is_new) {
        names_.push_back(entry->first);
        by_name_.emplace_back();
      }
      last_number = entry->second;
    }
    instance.name = last_number;
    by_name_[last_number].push_back(static_cast<std::uint32_t>(instances_.size()));
    instances_.push_back(instance);
  }
  data_end_ = scan.at();
  if (!scan.take("ENDSEC"))
    scan.expected("an instance (\"#\") or \"ENDSEC;\"");
  scan.skipSpace();
  scan.expect(';', "behind ENDSEC");
  scan.skipSpace();
  if (scan.peek() == 'D')
    scan.expected("\"END-ISO-10303-21;\" (several DATA sections are not read)");
  line("END-ISO-10303-21");
  // some programs end a file with zeros or a Ctrl-Z
  for (scan.skipSpace(); scan.peek() == '\0' || scan.peek() == '\x1a';
       scan.skipSpace()) {
    if (scan.ended())
      return;
    scan.skip();
  }
  scan.expected("nothing behind END-ISO-10303-21 (signed files are not read)");
}

void
Part21File::indexIds()
{
  const std::uint64_t n = instances_.size();
  std::uint64_t largest = 0;
  for (const Part21Instance& instance : instances_)
    largest = std::max(largest, instance.id);
  const auto twice = [this](std::uint32_t a, std::uint32_t b) {
    fail(instances_[std::max(a, b)].begin,
         "expected a new id, found #" + std::to_string(instances_[a].id) +
             " a second time; the first is at byte " +
             std::to_string(instances_[std::min(a, b)].begin));
  };
  dense_ = largest < 8 * n + 1024;
  if (dense_) {
    by_id_.assign(largest + 1, none);
    for (std::uint32_t i = 0; i < n; ++i) {
      std::uint32_t& place = by_id_[instances_[i].id];
      if (place != none)
        twice(place, i);
      place = i;
    }
    return;
  }
  by_id_.resize(n);
  for (std::uint32_t i = 0; i < n; ++i)
    by_id_[i] = i;
  std::sort(by_id_.begin(), by_id_.end(), [this](std::uint32_t a, std::uint32_t b) {
    return std::make_pair(instances_[a].id, a) < std::make_pair(instances_[b].id, b);
  });
  for (std::size_t i = 1; i < n; ++i)
    if (instances_[by_id_[i - 1]].id == instances_[by_id_[i]].id)
      twice(by_id_[i - 1], by_id_[i]);
}

std::uint64_t
Part21File::maxId() const
{
  if (instances_.empty())
    return 0;
  return dense_ ? by_id_.size() - 1 : instances_[by_id_.back()].id;
}

const Part21Instance*
Part21File::find(std::uint64_t id) const
{
  if (dense_) {
    if (id >= by_id_.size() || by_id_[id] == none)
      return nullptr;
    return &instances_[by_id_[id]];
  }
  const auto place = std::lower_bound(
      by_id_.begin(), by_id_.end(), id, [this](std::uint32_t i, std::uint64_t wanted) {
        return instances_[i].id < wanted;
      });
  if (place == by_id_.end() || instances_[*place].id != id)
    return nullptr;
  return &instances_[*place];
}

std::string_view
Part21File::entity(const Part21Instance& instance) const
{
  return names_[instance.name];
}

const std::vector<std::uint32_t>&
Part21File::ofType(std::string_view entity) const
{
  static const std::vector<std::uint32_t> nothing;
  const auto found = name_numbers_.find(std::string(entity));
  return found == name_numbers_.end() ? nothing : by_name_[found->second];
}

std::vector<Part21Record>
Part21File::records(const Part21Instance& instance) const
{
  Scanner scan(*bytes_, name_, instance.body);
  std::vector<Part21Record> out;
  const bool is_complex = scan.peek() == '(';
  if (is_complex) {
    scan.skip();
    scan.skipSpace();
  }
  do {
    Part21Record record;
    record.name = scan.takeName();
    if (record.name.empty())
      scan.expected("the name of an entity");
    scan.skipSpace();
    record.arguments = scan.items(0);
    scan.skipSpace();
    out.push_back(std::move(record));
  } while (is_complex && scan.peek() != ')');
  return out;
}

std::vector<Part21Value>
Part21File::arguments(const Part21Instance& instance) const
{
  if (instance.name == 0)
    fail(instance.begin,
         "expected a plain instance, found a complex one: #" +
             std::to_string(instance.id));
  return std::move(records(instance).front().arguments);
}

std::vector<std::uint32_t>
Part21File::countReferences() const
{
  std::vector<std::uint32_t> counts(instances_.size(), 0);
  for (const Part21Instance& instance : instances_) {
    Scanner scan(*bytes_, name_, instance.body);
    while (scan.at() < instance.end)
      switch (scan.peek()) {
      case '\'':
        scan.passText();
        break;
      case '/':
        scan.skipSpace();
        break;
      case '#': {
        const std::size_t at = scan.at();
        scan.skip();
        const std::uint64_t id = scan.takeId();
        const Part21Instance* const target = find(id);
        if (target == nullptr)
          fail(at,
               "expected an instance of the file, found #" + std::to_string(id) +
                   ", which is not there");
        ++counts[static_cast<std::size_t>(target - instances_.data())];
        break;
      }
      default:
        scan.skip();
      }
  }
  return counts;
}

void
Part21File::fail(std::size_t offset, const std::string& reason) const
{
  part21::fail(*bytes_, name_, offset, reason);
}

} // namespace hoist
