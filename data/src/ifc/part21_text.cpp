#include <hoist/data/ifc/part21.h>

#include <cstdint>
#include <string>

namespace hoist {
namespace {

void
appendUtf8(std::string& out, std::uint32_t c)
{
  if (c > 0x10ffff || (c >= 0xd800 && c < 0xe000))
    c = 0xfffd; // no character
  if (c < 0x80)
    out += static_cast<char>(c);
  else if (c < 0x800) {
    out += static_cast<char>(0xc0 | (c >> 6));
    out += static_cast<char>(0x80 | (c & 63));
  }
  else if (c < 0x10000) {
    out += static_cast<char>(0xe0 | (c >> 12));
    out += static_cast<char>(0x80 | (c >> 6 & 63));
    out += static_cast<char>(0x80 | (c & 63));
  }
  else {
    out += static_cast<char>(0xf0 | (c >> 18));
    out += static_cast<char>(0x80 | (c >> 12 & 63));
    out += static_cast<char>(0x80 | (c >> 6 & 63));
    out += static_cast<char>(0x80 | (c & 63));
  }
}

// The character at p and how many bytes it takes; a byte that is no UTF-8 is Latin-1.
std::uint32_t
nextCharacter(std::string_view s, std::size_t p, std::size_t& length)
{
  const auto byte = [&](std::size_t i) -> std::uint32_t {
    return i < s.size() ? static_cast<unsigned char>(s[i]) : 0u;
  };
  const std::uint32_t first = byte(p);
  length = 1;
  const int more = first >= 0xf0 && first < 0xf5   ? 3
                   : first >= 0xe0 && first < 0xf0 ? 2
                   : first >= 0xc2 && first < 0xe0 ? 1
                                                   : 0;
  if (more == 0)
    return first;
  std::uint32_t c = first & (0x3fu >> more);
  for (int i = 1; i <= more; ++i) {
    const std::uint32_t next = byte(p + i);
    if ((next & 0xc0) != 0x80)
      return first;
    c = c << 6 | (next & 63);
  }
  static constexpr std::uint32_t smallest[] = {0, 0x80, 0x800, 0x10000};
  if (c < smallest[more] || c > 0x10ffff || (c >= 0xd800 && c < 0xe000))
    return first;
  length = 1 + static_cast<std::size_t>(more);
  return c;
}

int
hexDigit(char c)
{
  if (c >= '0' && c <= '9')
    return c - '0';
  if (c >= 'A' && c <= 'F')
    return c - 'A' + 10;
  return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

// The number of n hexadecimal digits at p; -1 if they are not there.
std::int64_t
hexNumber(std::string_view s, std::size_t p, std::size_t n)
{
  if (p + n > s.size())
    return -1;
  std::int64_t value = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const int digit = hexDigit(s[p + i]);
    if (digit < 0)
      return -1;
    value = value << 4 | digit;
  }
  return value;
}

// \X2\ or \X4\ at p, up to its \X0\: the place behind it; p if it is none.
std::size_t
decodeRun(std::string_view s, std::size_t p, std::size_t digits, std::string& out)
{
  std::string text;
  std::size_t q = p + 4;
  std::uint32_t high = 0; // the first half of a surrogate pair, which some write
  while (s.substr(q, 4) != "\\X0\\") {
    const std::int64_t c = hexNumber(s, q, digits);
    if (c < 0)
      return p;
    if (c >= 0xd800 && c < 0xdc00)
      high = static_cast<std::uint32_t>(c);
    else if (high != 0 && c >= 0xdc00 && c < 0xe000) {
      appendUtf8(text, 0x10000 + ((high - 0xd800) << 10) + std::uint32_t(c - 0xdc00));
      high = 0;
    }
    else {
      appendUtf8(text, static_cast<std::uint32_t>(c));
      high = 0;
    }
    q += digits;
  }
  out += text;
  return q + 4;
}

// The escape that starts with the backslash at p: the place behind it.
std::size_t
decodeEscape(std::string_view s, std::size_t p, std::string& out)
{
  if (s.substr(p, 2) == "\\\\") {
    out += '\\';
    return p + 2;
  }
  if (s.substr(p, 4) == "\\X2\\" || s.substr(p, 4) == "\\X4\\") {
    const std::size_t behind = decodeRun(s, p, s[p + 2] == '2' ? 4 : 8, out);
    if (behind != p)
      return behind;
  }
  else if (s.substr(p, 3) == "\\X\\" && hexNumber(s, p + 3, 2) >= 0) {
    appendUtf8(out, static_cast<std::uint32_t>(hexNumber(s, p + 3, 2)));
    return p + 5;
  }
  else if (s.substr(p, 3) == "\\S\\" && p + 3 < s.size()) {
    appendUtf8(out, (static_cast<unsigned char>(s[p + 3]) & 0x7fu) | 0x80u);
    return p + 4;
  }
  else if (s.substr(p, 2) == "\\P" && p + 3 < s.size() && s[p + 3] == '\\')
    return p + 4; // which part of ISO 8859 \S\ means; all that was met is Latin-1
  out += '\\';
  return p + 1;
}

} // namespace

std::string
decodePart21(std::string_view quoted)
{
  std::string_view s = quoted;
  if (s.size() >= 2 && s.front() == '\'' && s.back() == '\'')
    s = s.substr(1, s.size() - 2);
  std::string out;
  out.reserve(s.size());
  for (std::size_t p = 0; p < s.size();) {
    if (s[p] == '\\')
      p = decodeEscape(s, p, out);
    else if (s[p] == '\'') {
      out += '\'';
      p += s.substr(p, 2) == "''" ? 2 : 1;
    }
    else {
      std::size_t length = 1;
      appendUtf8(out, nextCharacter(s, p, length));
      p += length;
    }
  }
  return out;
}

std::string
encodePart21(std::string_view text)
{
  static const char* const digits = "0123456789ABCDEF";
  std::string out = "'";
  int open = 0; // digits of the run that is open
  for (std::size_t p = 0; p < text.size();) {
    std::size_t length = 1;
    const std::uint32_t c = nextCharacter(text, p, length);
    p += length;
    const int wanted = c >= 32 && c < 127 ? 0 : c < 0x10000 ? 4 : 8;
    if (wanted != open) {
      if (open != 0)
        out += "\\X0\\";
      if (wanted != 0)
        out += wanted == 4 ? "\\X2\\" : "\\X4\\";
      open = wanted;
    }
    if (wanted == 0) {
      out += static_cast<char>(c);
      if (c == '\'' || c == '\\')
        out += static_cast<char>(c);
    }
    else
      for (int i = wanted - 1; i >= 0; --i)
        out += digits[c >> (4 * i) & 15];
  }
  return out + (open != 0 ? "\\X0\\'" : "'");
}

} // namespace hoist
