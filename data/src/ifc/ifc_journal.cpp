#include <hoist/data/atomic_file.h>
#include <hoist/data/ifc/ifc_guid.h>
#include <hoist/data/ifc/ifc_journal.h>

#include "../json_fields.h"

#include <nlohmann/json.hpp>

#include <pcl/exceptions.h>

#include <cstdint>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

namespace hoist {
namespace {

/// What was done last and how to take it back. Files are known by their SHA-1.
struct Entry {
  std::string before, after;
  std::vector<Part21Replacement> undo; ///< of the bytes after
};

// The bytes of a file may be no UTF-8, which JSON wants.
std::string
toHex(std::string_view bytes)
{
  std::string out;
  out.reserve(2 * bytes.size());
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    out += "0123456789abcdef"[byte >> 4];
    out += "0123456789abcdef"[byte & 15];
  }
  return out;
}

std::string
fromHex(const json::Value& value)
{
  const std::string_view digits = "0123456789abcdef";
  const std::string text = value.text();
  std::string out;
  for (std::size_t i = 0; i < text.size(); i += 2) {
    const std::size_t high = digits.find(text[i]);
    const std::size_t low =
        i + 1 < text.size() ? digits.find(text[i + 1]) : std::string_view::npos;
    if (high == std::string_view::npos || low == std::string_view::npos)
      value.fail("pairs of hexadecimal digits");
    out += static_cast<char>(high << 4 | low);
  }
  return out;
}

std::vector<Entry>
readJournal(const std::filesystem::path& file)
{
  std::vector<Entry> out;
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    return out;
  const std::string name = file.string();
  const json::Json parsed = json::parse(json::readText(file), name);
  json::Fields fields(json::Value(parsed, "", name));
  constexpr std::int64_t far = std::int64_t(1) << 50;
  for (const json::Value& item : fields.at("updates").items()) {
    json::Fields update(item);
    Entry entry;
    entry.before = update.at("before").text();
    entry.after = update.at("after").text();
    std::size_t last = 0;
    for (const json::Value& one : update.at("undo").items()) {
      json::Fields replacement(one);
      Part21Replacement undo;
      undo.begin = static_cast<std::size_t>(
          replacement.at("at").integerIn(static_cast<std::int64_t>(last), far));
      undo.end = undo.begin +
                 static_cast<std::size_t>(replacement.at("length").integerIn(0, far));
      undo.text = fromHex(replacement.at("bytes"));
      last = undo.end;
      entry.undo.push_back(std::move(undo));
    }
    out.push_back(std::move(entry));
  }
  return out;
}

void
writeJournal(const std::filesystem::path& file, const std::vector<Entry>& entries)
{
  json::Json updates = json::Json::array();
  const std::size_t first =
      entries.size() > ifc_journal_length ? entries.size() - ifc_journal_length : 0;
  for (std::size_t i = first; i < entries.size(); ++i) {
    json::Json undo = json::Json::array();
    for (const Part21Replacement& one : entries[i].undo)
      undo.push_back({{"at", one.begin},
                      {"length", one.end - one.begin},
                      {"bytes", toHex(one.text)}});
    updates.push_back({{"before", entries[i].before},
                       {"after", entries[i].after},
                       {"undo", std::move(undo)}});
  }
  const json::Json all = {{"format", "hoist ifc journal"}, {"updates", updates}};
  writeFileAtomically(file, all.dump(1) + "\n");
}

// What takes the replacements back, in the bytes that they lead to.
std::vector<Part21Replacement>
inverse(std::string_view bytes, const std::vector<Part21Replacement>& replacements)
{
  std::vector<Part21Replacement> out;
  std::size_t grown = 0; // may wrap: sizes are added and subtracted modulo 2^64
  for (const Part21Replacement& one : replacements) {
    const std::size_t begin = one.begin + grown;
    out.push_back({begin,
                   begin + one.text.size(),
                   std::string(bytes.substr(one.begin, one.end - one.begin))});
    grown += one.text.size() - (one.end - one.begin);
  }
  return out;
}

std::string
readAll(const std::filesystem::path& file)
{
  std::ifstream in(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  if (!in && bytes.empty())
    throw LoadError(file.string(), "", "cannot be read");
  return bytes;
}

// The file itself, not a link to it: a link is to go on leading there.
std::filesystem::path
target(const std::filesystem::path& model)
{
  std::error_code error;
  std::filesystem::path out = std::filesystem::canonical(model, error);
  return error ? model : out;
}

void
replaceFile(const std::filesystem::path& model, const std::string& bytes)
{
  AtomicFile file(model);
  file.write(bytes);
  // who may read and write it stays; a new file would have the defaults
  std::error_code error;
  const auto status = std::filesystem::status(model, error);
  if (!error)
    std::filesystem::permissions(file.temporary(), status.permissions(), error);
  file.commit();
}

} // namespace

std::filesystem::path
ifcJournalOf(const std::filesystem::path& model)
{
  std::filesystem::path out = model;
  out += ".journal";
  return out;
}

bool
commitIfc(const std::filesystem::path& path, const Part21Edit& edit)
{
  if (edit.empty())
    return false;
  const std::filesystem::path model = target(path);
  const std::string& old = edit.file().bytes();
  if (readAll(model) != old)
    PCL_THROW_EXCEPTION(pcl::IOException,
                        path.string()
                            << ": was changed by somebody else; nothing is written");
  const std::vector<Part21Replacement> replacements = edit.replacements();
  const std::string bytes = applyReplacements(old, replacements);
  std::vector<Entry> entries = readJournal(ifcJournalOf(model));
  entries.push_back({sha1Hex(old), sha1Hex(bytes), inverse(old, replacements)});
  // the journal first: an entry of an update that never came is passed over
  writeJournal(ifcJournalOf(model), entries);
  replaceFile(model, bytes);
  return true;
}

bool
undoIfc(const std::filesystem::path& path)
{
  const std::filesystem::path model = target(path);
  std::vector<Entry> entries = readJournal(ifcJournalOf(model));
  if (entries.empty())
    return false;
  const std::string bytes = readAll(model);
  const std::string now = sha1Hex(bytes);
  // Entries of updates that never came, or of one that is undone already: a crash may
  // have been between the two files.
  while (!entries.empty() && entries.back().after != now &&
         entries.back().before == now)
    entries.pop_back();
  if (entries.empty()) {
    writeJournal(ifcJournalOf(model), entries);
    return false;
  }
  const Entry last = entries.back();
  if (last.after != now)
    PCL_THROW_EXCEPTION(pcl::IOException,
                        path.string() << ": was changed by somebody else since the "
                                         "last update; nothing is undone");
  if (!last.undo.empty() && last.undo.back().end > bytes.size())
    throw LoadError(
        ifcJournalOf(model).string(), "", "undoes more bytes than the file has");
  const std::string before = applyReplacements(bytes, last.undo);
  if (sha1Hex(before) != last.before)
    throw LoadError(
        ifcJournalOf(model).string(), "", "does not lead back to the file before");
  replaceFile(model, before);
  entries.pop_back();
  writeJournal(ifcJournalOf(model), entries);
  return true;
}

} // namespace hoist
