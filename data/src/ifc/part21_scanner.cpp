#include "part21_scanner.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace hoist {
namespace part21 {
namespace {

bool
isSpace(char c)
{
  return c == ' ' || (c >= '\t' && c <= '\r');
}

bool
isDigit(char c)
{
  return c >= '0' && c <= '9';
}

bool
isLetter(char c)
{
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_';
}

// What the quick way through a list must look at.
constexpr std::array<bool, 256>
specialBytes()
{
  std::array<bool, 256> special{};
  for (int c = 0; c < 256; ++c)
    special[c] = (c < 32 && !(c >= 9 && c <= 13)) || c >= 127;
  for (const char c : {'(', ')', '\'', '"', ';', '/'})
    special[static_cast<unsigned char>(c)] = true;
  return special;
}

constexpr std::array<bool, 256> is_special = specialBytes();

// What stands at a place, for a message.
std::string
found(const std::string& bytes, std::size_t at)
{
  if (at >= bytes.size())
    return "the end of the file";
  std::string out;
  for (std::size_t i = at; i < bytes.size() && i < at + 16; ++i) {
    const char c = bytes[i];
    if (c < 32 || c == 127) { // char is signed: what is not ASCII, too
      if (i == at) {
        static const char* const digits = "0123456789abcdef";
        const auto byte = static_cast<unsigned char>(c);
        return std::string("the byte 0x") + digits[byte >> 4] + digits[byte & 15];
      }
      break;
    }
    out += c;
  }
  return '"' + out + '"';
}

} // namespace

void
fail(const std::string& bytes,
     const std::string& file,
     std::size_t offset,
     const std::string& reason)
{
  offset = std::min(offset, bytes.size());
  const auto line = 1 + std::count(bytes.begin(),
                                   bytes.begin() + static_cast<std::ptrdiff_t>(offset),
                                   '\n');
  throw LoadError(
      file, std::to_string(line), reason + " (byte " + std::to_string(offset) + ")");
}

std::string
upperCase(std::string_view text)
{
  std::string out(text);
  for (char& c : out)
    if (c >= 'a' && c <= 'z')
      c = static_cast<char>(c - 'a' + 'A');
  return out;
}

void
Scanner::failAt(std::size_t offset, const std::string& reason) const
{
  fail(*bytes_, *file_, offset, reason);
}

void
Scanner::expected(const std::string& what) const
{
  failAt(at_, "expected " + what + ", found " + found(*bytes_, at_));
}

void
Scanner::skipSpace()
{
  const std::string& s = *bytes_;
  while (at_ < s.size())
    if (isSpace(s[at_]))
      ++at_;
    else if (s[at_] == '/' && at_ + 1 < s.size() && s[at_ + 1] == '*') {
      const std::size_t end = s.find("*/", at_ + 2);
      if (end == std::string::npos)
        failAt(at_, "expected a comment to end with */");
      at_ = end + 2;
    }
    else
      return;
}

bool
Scanner::take(std::string_view word)
{
  if (bytes_->compare(at_, word.size(), word) != 0)
    return false;
  at_ += word.size();
  return true;
}

void
Scanner::expect(char c, const char* where)
{
  if (ended() || peek() != c)
    expected(std::string("\"") + c + "\" " + where);
  ++at_;
}

std::string_view
Scanner::takeName()
{
  const std::size_t first = at_;
  if (isLetter(peek()))
    while (isLetter(peek()) || isDigit(peek()))
      ++at_;
  return std::string_view(*bytes_).substr(first, at_ - first);
}

std::uint64_t
Scanner::takeId()
{
  const std::size_t first = at_;
  std::uint64_t id = 0;
  for (; isDigit(peek()); ++at_) {
    id = id * 10 + static_cast<unsigned>(peek() - '0');
    if (id >= max_id)
      failAt(first, "expected an id below 2^62");
  }
  if (at_ == first)
    expected("the digits of an id behind \"#\"");
  return id;
}

void
Scanner::passText()
{
  const std::size_t first = at_;
  // a doubled quote ends one text and begins the next: the same in the end
  const std::size_t end = bytes_->find('\'', first + 1);
  if (end == std::string::npos)
    failAt(first, "expected a text to end with a quote");
  at_ = end + 1;
}

void
Scanner::passBinary()
{
  const std::size_t first = at_++;
  while (isDigit(peek()) || (peek() >= 'A' && peek() <= 'F'))
    ++at_;
  if (ended() || peek() != '"')
    failAt(first, "expected hexadecimal digits and a closing double quote");
  ++at_;
}

void
Scanner::passList()
{
  const std::size_t first = at_;
  const std::string& s = *bytes_;
  int depth = 0;
  while (at_ < s.size()) {
    const auto c = static_cast<unsigned char>(s[at_]);
    if (!is_special[c]) {
      ++at_;
      continue;
    }
    switch (c) {
    case '(':
      if (++depth > max_depth)
        failAt(at_, "nested deeper than " + std::to_string(max_depth) + " lists");
      ++at_;
      break;
    case ')':
      ++at_;
      if (--depth == 0)
        return;
      break;
    case '\'':
      passText();
      break;
    case '"':
      passBinary();
      break;
    case '/':
      if (at_ + 1 >= s.size() || s[at_ + 1] != '*')
        expected("an argument");
      skipSpace();
      break;
    default:
      expected("an argument or \")\"");
    }
  }
  failAt(first, "expected the list to end with \")\", found the end of the file");
}

void
Scanner::takeNumber(Part21Value& out)
{
  const std::string& s = *bytes_;
  const std::size_t first = at_;
  const bool plus = peek() == '+';
  const char* const begin = s.data() + first + (plus ? 1 : 0);
  const char* const end = s.data() + s.size();
  const auto [stop, error] = std::from_chars(begin, end, out.number);
  if (error == std::errc::result_out_of_range)
    failAt(first, "expected a number that a computer can hold");
  // "inf" and "nan" are letters, which no argument starts with
  if (error != std::errc() || (plus && *begin == '-') || !std::isfinite(out.number))
    expected("an argument");
  out.kind = Part21Value::Kind::integer;
  for (const char* p = begin; p != stop; ++p)
    if (!isDigit(*p) && *p != '-')
      out.kind = Part21Value::Kind::real;
  at_ = static_cast<std::size_t>(stop - s.data());
}

std::vector<Part21Value>
Scanner::items(int depth)
{
  if (depth > max_depth)
    failAt(at_, "nested deeper than " + std::to_string(max_depth) + " lists");
  expect('(', "before the arguments");
  std::vector<Part21Value> out;
  skipSpace();
  if (peek() == ')') {
    ++at_;
    return out;
  }
  for (;;) {
    out.push_back(value(depth));
    skipSpace();
    if (peek() == ',')
      ++at_;
    else {
      expect(')', "or \",\" behind an argument");
      return out;
    }
  }
}

Part21Value
Scanner::value(int depth)
{
  skipSpace();
  Part21Value out;
  const std::size_t first = at_;
  const char c = peek();
  using Kind = Part21Value::Kind;
  if (c == '$' || c == '*') {
    out.kind = c == '$' ? Kind::unset : Kind::derived;
    ++at_;
  }
  else if (c == '\'') {
    out.kind = Kind::text;
    while (peek() == '\'') // each doubled quote goes on
      passText();
  }
  else if (c == '"') {
    out.kind = Kind::binary;
    passBinary();
  }
  else if (c == '#') {
    out.kind = Kind::reference;
    ++at_;
    out.id = takeId();
  }
  else if (c == '(') {
    out.kind = Kind::list;
    out.items = items(depth + 1);
  }
  else if (c == '.' && at_ + 1 < bytes_->size() && isLetter((*bytes_)[at_ + 1])) {
    out.kind = Kind::enumeration;
    ++at_;
    takeName();
    expect('.', "behind the word of an enumeration");
  }
  else if (isLetter(c)) {
    out.kind = Kind::typed;
    takeName();
    skipSpace();
    out.items = items(depth + 1);
  }
  else if (isDigit(c) || c == '-' || c == '+' || c == '.')
    takeNumber(out);
  else
    expected("an argument");
  out.raw = std::string_view(*bytes_).substr(first, at_ - first);
  return out;
}

} // namespace part21
} // namespace hoist
