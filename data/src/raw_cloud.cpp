#include "raw_cloud.h"

#include "parse_number.h"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>

namespace hoist {
namespace detail {
namespace {

template <typename T>
T
load(const std::uint8_t* bytes)
{
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

double
toDouble(NumberType type, const std::uint8_t* bytes)
{
  switch (type.kind) {
  case 'F':
    return type.size == 8 ? load<double>(bytes) : load<float>(bytes);
  case 'I':
    switch (type.size) {
    case 1:
      return load<std::int8_t>(bytes);
    case 2:
      return load<std::int16_t>(bytes);
    case 4:
      return load<std::int32_t>(bytes);
    default:
      return static_cast<double>(load<std::int64_t>(bytes));
    }
  default:
    switch (type.size) {
    case 1:
      return load<std::uint8_t>(bytes);
    case 2:
      return load<std::uint16_t>(bytes);
    case 4:
      return load<std::uint32_t>(bytes);
    default:
      return static_cast<double>(load<std::uint64_t>(bytes));
    }
  }
}

std::uint32_t
toByte(double value)
{
  return value > 0 ? static_cast<std::uint32_t>(std::lround(std::min(value, 255.0)))
                   : 0;
}

// A pixel number that no image has, for what is no pixel number.
std::uint32_t
toPixel(double value)
{
  return value >= 0 && value < 1e9 && value == std::floor(value)
             ? static_cast<std::uint32_t>(value)
             : std::numeric_limits<std::uint32_t>::max();
}

template <typename T>
bool
store(const char* text, std::uint8_t* bytes)
{
  T value{};
  const char* stop = text;
  if constexpr (std::is_floating_point_v<T>)
    stop = parseReal(text, value);
  else {
    const char* end = text;
    while (!endsNumber(*end))
      ++end;
    const auto result = std::from_chars(text + (*text == '+' ? 1 : 0), end, value);
    stop = result.ec == std::errc() ? result.ptr : nullptr;
  }
  if (stop == nullptr || !endsNumber(*stop))
    return false;
  std::memcpy(bytes, &value, sizeof(T));
  return true;
}

} // namespace

Role
roleOf(const std::string& name)
{
  static const std::pair<const char*, Role> table[] = {{"x", Role::x},
                                                       {"y", Role::y},
                                                       {"z", Role::z},
                                                       {"rgb", Role::packed_color},
                                                       {"rgba", Role::packed_color},
                                                       {"r", Role::red},
                                                       {"g", Role::green},
                                                       {"b", Role::blue},
                                                       {"red", Role::red},
                                                       {"green", Role::green},
                                                       {"blue", Role::blue},
                                                       {"intensity", Role::intensity},
                                                       {"u", Role::u},
                                                       {"v", Role::v}};
  for (const auto& [text, role] : table)
    if (name == text)
      return role;
  return Role::none;
}

void
assign(Record& record, Role role, NumberType type, const std::uint8_t* bytes)
{
  switch (role) {
  case Role::none:
    return;
  case Role::x:
    record.x = static_cast<float>(toDouble(type, bytes));
    return;
  case Role::y:
    record.y = static_cast<float>(toDouble(type, bytes));
    return;
  case Role::z:
    record.z = static_cast<float>(toDouble(type, bytes));
    return;
  case Role::packed_color: // the bits count, be they called a float or an integer
    record.color = load<std::uint32_t>(bytes) | 0xff000000u;
    return;
  case Role::red:
    record.color = (record.color & 0xff00ffffu) | toByte(toDouble(type, bytes)) << 16;
    return;
  case Role::green:
    record.color = (record.color & 0xffff00ffu) | toByte(toDouble(type, bytes)) << 8;
    return;
  case Role::blue:
    record.color = (record.color & 0xffffff00u) | toByte(toDouble(type, bytes));
    return;
  case Role::intensity: {
    const std::uint32_t grey = toByte(toDouble(type, bytes));
    record.color = 0xff000000u | grey << 16 | grey << 8 | grey;
    return;
  }
  case Role::u:
    record.u = toPixel(toDouble(type, bytes));
    return;
  case Role::v:
    record.v = toPixel(toDouble(type, bytes));
    return;
  }
}

bool
textToBytes(const char* text, NumberType type, std::uint8_t* bytes)
{
  switch (type.kind) {
  case 'F':
    return type.size == 8 ? store<double>(text, bytes) : store<float>(text, bytes);
  case 'I':
    switch (type.size) {
    case 1:
      return store<std::int8_t>(text, bytes);
    case 2:
      return store<std::int16_t>(text, bytes);
    case 4:
      return store<std::int32_t>(text, bytes);
    default:
      return store<std::int64_t>(text, bytes);
    }
  default:
    switch (type.size) {
    case 1:
      return store<std::uint8_t>(text, bytes);
    case 2:
      return store<std::uint16_t>(text, bytes);
    case 4:
      return store<std::uint32_t>(text, bytes);
    default:
      return store<std::uint64_t>(text, bytes);
    }
  }
}

void
checkRoles(const std::string& file, std::vector<Role>& roles, RawCloud& cloud)
{
  const auto count = [&](Role role) {
    return std::count(roles.begin(), roles.end(), role);
  };
  for (const auto& [role, name] :
       {std::pair(Role::x, "x"), std::pair(Role::y, "y"), std::pair(Role::z, "z")})
    if (count(role) != 1)
      throw LoadError(
          file,
          "",
          std::string(count(role) == 0 ? "has no field " : "has more than one field ") +
              name + ": a frame needs x, y and z");
  const bool packed = count(Role::packed_color) > 0;
  const bool parts =
      count(Role::red) == 1 && count(Role::green) == 1 && count(Role::blue) == 1;
  cloud.has_color = packed || parts || count(Role::intensity) == 1;
  cloud.has_pixels = count(Role::u) == 1 && count(Role::v) == 1;
  const auto drop = [&](std::initializer_list<Role> others) {
    for (Role& role : roles)
      if (std::find(others.begin(), others.end(), role) != others.end())
        role = Role::none;
  };
  if (packed || !parts)
    drop({Role::red, Role::green, Role::blue});
  if (packed || parts || count(Role::intensity) > 1)
    drop({Role::intensity});
  if (!cloud.has_pixels)
    drop({Role::u, Role::v});
  if (packed) { // rgb and rgba: the first
    const auto first = std::find(roles.begin(), roles.end(), Role::packed_color);
    std::replace(first + 1, roles.end(), Role::packed_color, Role::none);
  }
}

std::string
readHead(const std::string& file, std::size_t bytes, std::uint64_t& size)
{
  struct stat info {};
  if (::stat(file.c_str(), &info) != 0)
    throw LoadError(file, "", std::strerror(errno));
  if (!S_ISREG(info.st_mode))
    throw LoadError(file, "", "is not a regular file");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(
      std::fopen(file.c_str(), "rb"), &std::fclose);
  if (!in)
    throw LoadError(file, "", std::strerror(errno));
  size = static_cast<std::uint64_t>(info.st_size);
  if (size == 0)
    throw LoadError(file, "", "the file is empty");
  std::string head(std::min<std::uint64_t>(bytes, size), '\0');
  head.resize(std::fread(head.data(), 1, head.size(), in.get()));
  return head;
}

} // namespace detail
} // namespace hoist
