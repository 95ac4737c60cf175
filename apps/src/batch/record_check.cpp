#include "batch/record_check.h"

namespace hoist {

std::optional<RecordHead>
RecordCheck::find(const InputFile& file, const Stamp& stamp, std::string& text) const
{
  std::optional<std::string> bytes = readBytes(folder / recordFile(file));
  if (!bytes)
    return std::nullopt;
  text = std::move(*bytes);
  std::optional<RecordHead> head = readRecordHead(text);
  if (!head || head->version != version || head->settings != settings ||
      !(head->stamp == stamp))
    return std::nullopt;
  for (const Extra& extra : head->extras)
    if (const Stamp found = stampOf(folder / extraFile(file, extra.suffix));
        !found.exists || found.size != extra.size)
      return std::nullopt;
  return head;
}

std::optional<RecordHead>
RecordCheck::standing(const InputFile& file, const Stamp& stamp) const
{
  std::string text;
  std::optional<RecordHead> head = find(file, stamp, text);
  if (!head || head->verdict.cause == Cause::none)
    return head;
  const Verdict& verdict = head->verdict;
  const std::string& limit = verdict.cause == Cause::memory ? memory_limit
                             : verdict.cause == Cause::hang ? time_limit
                                                            : verdict.limit;
  return retry || verdict.limit != limit ? std::nullopt : head;
}

std::optional<RecordHead>
RecordCheck::finished(const InputFile& file, std::string& text) const
{
  return find(file, stampOf(file.path), text);
}

} // namespace hoist
