#include <hoist/data/ifc/part21_edit.h>

#include <pcl/exceptions.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace hoist {
namespace {

/// Many programs keep ids in 32 bits, some with a sign: new ones stay below.
constexpr std::uint64_t comfortable_id = (std::uint64_t(1) << 31) - 1;

} // namespace

std::string
applyReplacements(std::string_view bytes,
                  const std::vector<Part21Replacement>& replacements)
{
  std::string out;
  std::size_t size = bytes.size();
  for (const Part21Replacement& one : replacements)
    size += one.text.size();
  out.reserve(size);
  std::size_t at = 0;
  for (const Part21Replacement& one : replacements) {
    out += bytes.substr(at, one.begin - at);
    out += one.text;
    at = one.end;
  }
  out += bytes.substr(at);
  return out;
}

std::string
part21Real(double value, int decimals)
{
  if (!std::isfinite(value))
    PCL_THROW_EXCEPTION(pcl::BadArgumentException, "a number that is not finite");
  std::array<char, 400> buffer{};
  const auto result = std::to_chars(buffer.data(),
                                    buffer.data() + buffer.size(),
                                    value,
                                    std::chars_format::fixed,
                                    decimals);
  std::string text(buffer.data(), result.ptr);
  if (text.find('.') == std::string::npos)
    text += '.';
  while (text.back() == '0')
    text.pop_back();
  return text == "-0." ? "0." : text;
}

std::string
part21Reference(std::uint64_t id)
{
  return '#' + std::to_string(id);
}

Part21Edit::Part21Edit(const Part21File& file) : file_(&file)
{
  next_id_ = file_->maxId() + 1;
  if (next_id_ > comfortable_id) {
    ids_in_gaps_ = true;
    next_id_ = 1;
  }
}

std::uint64_t
Part21Edit::freeId()
{
  if (next_id_ > comfortable_id) {
    if (ids_in_gaps_)
      PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                          file_->name() << ": no id is left");
    ids_in_gaps_ = true;
    next_id_ = 1;
  }
  if (ids_in_gaps_)
    while (file_->find(next_id_) != nullptr || added_.count(next_id_) != 0)
      ++next_id_;
  return next_id_++;
}

std::uint64_t
Part21Edit::append(std::string_view entity, std::vector<std::string> arguments)
{
  const std::uint64_t id = freeId();
  added_[id] = {std::string(entity), std::move(arguments)};
  order_.push_back(id);
  ++touched_;
  return id;
}

void
Part21Edit::set(std::uint64_t id, std::size_t argument, std::string text)
{
  if (const auto added = added_.find(id); added != added_.end()) {
    std::string& current = added->second.arguments.at(argument);
    touched_ += current == text ? 0 : 1;
    current = std::move(text);
    return;
  }
  if (get(id, argument) == text)
    return;
  const Part21Instance* const instance = file_->find(id);
  if (instance == nullptr)
    throw LoadError(file_->name(), "", "there is no instance #" + std::to_string(id));
  const std::vector<Part21Value> arguments = file_->arguments(*instance);
  if (argument >= arguments.size())
    file_->fail(instance->begin,
                "expected " + std::to_string(argument + 1) + " arguments, found " +
                    std::to_string(arguments.size()));
  const std::string_view raw = arguments[argument].raw;
  ++touched_;
  auto& changes = changed_[id];
  if (raw == text)
    changes.erase(argument);
  else {
    const auto begin = static_cast<std::size_t>(raw.data() - file_->bytes().data());
    changes[argument] = {begin, begin + raw.size(), std::move(text)};
  }
  if (changes.empty())
    changed_.erase(id);
}

std::string
Part21Edit::get(std::uint64_t id, std::size_t argument) const
{
  if (const auto added = added_.find(id); added != added_.end())
    return argument < added->second.arguments.size() ? added->second.arguments[argument]
                                                     : "";
  if (const auto changed = changed_.find(id); changed != changed_.end())
    if (const auto one = changed->second.find(argument); one != changed->second.end())
      return one->second.text;
  const Part21Instance* const instance = file_->find(id);
  if (instance == nullptr)
    throw LoadError(file_->name(), "", "there is no instance #" + std::to_string(id));
  const std::vector<Part21Value> arguments = file_->arguments(*instance);
  return argument < arguments.size() ? std::string(arguments[argument].raw) : "";
}

std::string_view
Part21Edit::entity(std::uint64_t id) const
{
  if (const auto added = added_.find(id); added != added_.end())
    return added->second.entity;
  const Part21Instance* const instance = file_->find(id);
  return instance == nullptr ? std::string_view() : file_->entity(*instance);
}

bool
Part21Edit::empty() const
{
  return changed_.empty() && added_.empty();
}

std::string
Part21Edit::textOf(std::uint64_t id, const Added& added)
{
  std::string out = part21Reference(id) + '=' + added.entity + '(';
  for (std::size_t i = 0; i < added.arguments.size(); ++i)
    out += (i == 0 ? "" : ",") + added.arguments[i];
  return out + ");";
}

std::vector<Part21Replacement>
Part21Edit::replacements() const
{
  std::vector<Part21Replacement> out;
  for (const auto& [id, changes] : changed_)
    for (const auto& [argument, one] : changes)
      out.push_back(one);
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) {
    return a.begin < b.begin;
  });
  if (order_.empty())
    return out;
  const std::string& bytes = file_->bytes();
  const std::size_t line = bytes.find('\n');
  const bool dos = line != std::string::npos && line > 0 && bytes[line - 1] == '\r';
  const std::string end = dos ? "\r\n" : "\n";
  Part21Replacement added{file_->dataEnd(), file_->dataEnd(), ""};
  if (bytes[added.begin - 1] != '\n')
    added.text = end;
  for (const std::uint64_t id : order_)
    added.text += textOf(id, added_.at(id)) + end;
  out.push_back(std::move(added));
  return out;
}

std::string
Part21Edit::bytes() const
{
  return applyReplacements(file_->bytes(), replacements());
}

std::string
Part21Edit::diff() const
{
  std::string out;
  const std::string_view bytes = file_->bytes();
  const auto line = [&](char sign, std::string text) {
    for (char& c : text)
      if (c == '\n' || c == '\r')
        c = ' ';
    out += sign + text + '\n';
  };
  for (const auto& [id, changes] : changed_) {
    const Part21Instance& instance = *file_->find(id);
    line('-', std::string(bytes.substr(instance.begin, instance.end - instance.begin)));
    std::vector<Part21Replacement> parts;
    for (const auto& [argument, one] : changes)
      parts.push_back({one.begin - instance.begin, one.end - instance.begin, one.text});
    line('+',
         applyReplacements(bytes.substr(instance.begin, instance.end - instance.begin),
                           parts));
  }
  for (const std::uint64_t id : order_)
    line('+', textOf(id, added_.at(id)));
  return out;
}

} // namespace hoist
