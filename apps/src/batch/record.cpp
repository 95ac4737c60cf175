#include "batch/record.h"

#include "batch/hash.h"

#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <exception>
#include <utility>

namespace hoist {
namespace {

using Json = nlohmann::ordered_json;

constexpr int format = 1;
constexpr const char* causes[] = {"", "input", "memory", "crash", "hang"};
constexpr const char* check_key = ",\n \"check\": \"";
constexpr const char* thumbnail_key =
    ",\n \"thumbnail\": \"data:image/jpeg;base64,"; // up to the data

std::string
base64(const std::string& bytes)
{
  constexpr const char* digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(bytes.size() * 4 / 3 + 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 |
              (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

Json
headJson(const RecordHead& head)
{
  Json json;
  json["format"] = format;
  json["version"] = head.version;
  json["settings"] = head.settings;
  json["path"] = head.path;
  if (head.stamp.exists) {
    json["size"] = head.stamp.size;
    json["mtime_ns"] = head.stamp.mtime;
  }
  json["status"] = head.status();
  if (head.verdict.cause != Cause::none) {
    json["cause"] = toString(head.verdict.cause);
    json["reason"] = head.verdict.reason;
    if (!head.verdict.limit.empty())
      json["limit"] = head.verdict.limit;
  }
  json["extras"] = Json::object();
  for (const Extra& extra : head.extras)
    json["extras"][extra.suffix] = extra.size;
  return json;
}

RecordHead
headFrom(const Json& json)
{
  RecordHead head;
  head.version = json.at("version");
  head.settings = json.at("settings");
  head.path = json.at("path");
  head.stamp.exists = json.contains("size");
  if (head.stamp.exists) {
    head.stamp.size = json.at("size");
    head.stamp.mtime = json.at("mtime_ns");
  }
  if (json.at("status") == "quarantined") {
    for (int i = 0; i < 5; ++i)
      if (json.at("cause") == causes[i])
        head.verdict.cause = static_cast<Cause>(i);
    head.verdict.reason = json.at("reason");
    head.verdict.limit = json.value("limit", "");
  }
  for (const auto& [suffix, size] : json.at("extras").items())
    head.extras.push_back({suffix, size.get<std::uint64_t>()});
  return head;
}

} // namespace

const char*
toString(Cause cause)
{
  return causes[static_cast<int>(cause)];
}

Stamp
stampOf(const std::string& path)
{
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0)
    return {};
  return {true,
          static_cast<std::uint64_t>(info.st_size),
          std::int64_t{info.st_mtim.tv_sec} * 1000000000 + info.st_mtim.tv_nsec};
}

std::string
makeRecord(const RecordHead& head,
           const std::string& result,
           const std::string& thumbnail)
{
  std::string text =
      "{\"batch\": " +
      headJson(head).dump(-1, ' ', false, Json::error_handler_t::replace);
  // the result's braces give way to the record's: "{\n ... \n}\n"
  if (result.size() > 5)
    text += ",\n" + result.substr(2, result.size() - 5);
  if (!thumbnail.empty())
    text += thumbnail_key + base64(thumbnail) + "\"";
  text += check_key;
  return text + hexOf(hashOf(text)) + "\"\n}\n";
}

std::optional<RecordHead>
readRecordHead(std::string_view text)
{
  constexpr std::size_t tail = 16 + 4; // the hash and what closes the object
  if (text.size() < tail || text.substr(text.size() - 4) != "\"\n}\n")
    return std::nullopt;
  const std::string_view checked = text.substr(0, text.size() - tail);
  if (hexOf(hashOf(checked)) != text.substr(checked.size(), 16))
    return std::nullopt;
  const std::string_view start = "{\"batch\": ";
  std::size_t end = checked.find('\n');
  if (end == std::string_view::npos || checked.substr(0, start.size()) != start)
    return std::nullopt;
  --end; // the comma
  try {
    const Json json = Json::parse(checked.substr(start.size(), end - start.size()));
    if (json.at("format") != format)
      return std::nullopt;
    return headFrom(json);
  }
  catch (const std::exception&) {
    return std::nullopt;
  }
}

std::string
thumbnailOf(std::string_view record)
{
  const std::size_t key = record.rfind(thumbnail_key);
  if (key == std::string_view::npos)
    return "";
  const std::size_t start = record.find("data:", key);
  return std::string(record.substr(start, record.find('"', start) - start));
}

std::optional<std::string>
readBytes(const std::string& path)
{
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0)
    return std::nullopt;
  std::string bytes;
  std::array<char, 65536> block{};
  for (;;) {
    const ssize_t n = ::read(file, block.data(), block.size());
    if (n < 0 && errno == EINTR)
      continue;
    if (n <= 0) {
      ::close(file);
      return n == 0 ? std::optional<std::string>(std::move(bytes)) : std::nullopt;
    }
    bytes.append(block.data(), static_cast<std::size_t>(n));
  }
}

} // namespace hoist
