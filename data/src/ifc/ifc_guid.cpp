#include <hoist/data/ifc/ifc_guid.h>

#include <algorithm>
#include <cstddef>

namespace hoist {
namespace {

const char* const alphabet =
    "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_$";

std::uint32_t
rotated(std::uint32_t x, int bits)
{
  return x << bits | x >> (32 - bits);
}

// One block of 64 bytes (FIPS 180-4, 6.1.2).
void
addBlock(std::array<std::uint32_t, 5>& hash, const unsigned char* block)
{
  std::array<std::uint32_t, 80> w{};
  for (int i = 0; i < 16; ++i)
    w[i] = std::uint32_t(block[4 * i]) << 24 | std::uint32_t(block[4 * i + 1]) << 16 |
           std::uint32_t(block[4 * i + 2]) << 8 | block[4 * i + 3];
  for (int i = 16; i < 80; ++i)
    w[i] = rotated(w[i - 3] ^ w[i - 8] ^ w[i - 14] ^ w[i - 16], 1);
  auto [a, b, c, d, e] = hash;
  for (int i = 0; i < 80; ++i) {
    std::uint32_t f = b ^ c ^ d;
    std::uint32_t k = i < 40 ? 0x6ed9eba1u : 0xca62c1d6u;
    if (i < 20) {
      f = (b & c) | (~b & d);
      k = 0x5a827999u;
    }
    else if (i >= 40 && i < 60) {
      f = (b & c) | (b & d) | (c & d);
      k = 0x8f1bbcdcu;
    }
    const std::uint32_t next = rotated(a, 5) + f + e + k + w[i];
    e = d;
    d = c;
    c = rotated(b, 30);
    b = a;
    a = next;
  }
  hash[0] += a;
  hash[1] += b;
  hash[2] += c;
  hash[3] += d;
  hash[4] += e;
}

} // namespace

std::array<std::uint8_t, 20>
sha1(std::string_view bytes)
{
  std::array<std::uint32_t, 5> hash = {
      0x67452301u, 0xefcdab89u, 0x98badcfeu, 0x10325476u, 0xc3d2e1f0u};
  const auto* p = reinterpret_cast<const unsigned char*>(bytes.data());
  std::size_t left = bytes.size();
  for (; left >= 64; left -= 64, p += 64)
    addBlock(hash, p);
  std::array<unsigned char, 128> tail{};
  std::copy(p, p + left, tail.begin());
  tail[left] = 0x80;
  const std::size_t blocks = left < 56 ? 1 : 2;
  const std::uint64_t bits = std::uint64_t(bytes.size()) * 8;
  for (std::size_t i = 0; i < 8; ++i)
    tail[blocks * 64 - 1 - i] = static_cast<unsigned char>(bits >> (8 * i));
  for (std::size_t i = 0; i < blocks; ++i)
    addBlock(hash, tail.data() + 64 * i);
  std::array<std::uint8_t, 20> out{};
  for (std::size_t i = 0; i < 20; ++i)
    out[i] = static_cast<std::uint8_t>(hash[i / 4] >> (24 - 8 * (i % 4)));
  return out;
}

std::string
sha1Hex(std::string_view bytes)
{
  std::string out;
  for (const std::uint8_t byte : sha1(bytes)) {
    out += "0123456789abcdef"[byte >> 4];
    out += "0123456789abcdef"[byte & 15];
  }
  return out;
}

std::string
toIfcGuid(const Uuid& uuid)
{
  std::string out;
  // one byte as two characters, then three bytes as four, five times
  for (std::size_t i = 0; i < 16;) {
    const std::size_t n = i == 0 ? 1 : 3;
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < n; ++k)
      value = value << 8 | uuid[i + k];
    for (int digit = n == 1 ? 1 : 3; digit >= 0; --digit)
      out += alphabet[value >> (6 * digit) & 63];
    i += n;
  }
  return out;
}

std::optional<Uuid>
fromIfcGuid(std::string_view guid)
{
  if (guid.size() != 22)
    return std::nullopt;
  Uuid out{};
  std::size_t at = 0, byte = 0;
  const std::string_view letters(alphabet);
  while (at < 22) {
    const std::size_t n = at == 0 ? 2 : 4;
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t digit = letters.find(guid[at + k]);
      if (digit == std::string_view::npos)
        return std::nullopt;
      value = value << 6 | static_cast<std::uint32_t>(digit);
    }
    if (n == 2 && value > 255)
      return std::nullopt;
    for (int k = n == 2 ? 0 : 2; k >= 0; --k)
      out[byte++] = static_cast<std::uint8_t>(value >> (8 * k));
    at += n;
  }
  return out;
}

Uuid
nameUuid(const Uuid& space, std::string_view name)
{
  std::string text(space.begin(), space.end());
  text += name;
  const auto hash = sha1(text);
  Uuid out{};
  std::copy(hash.begin(), hash.begin() + 16, out.begin());
  out[6] = static_cast<std::uint8_t>((out[6] & 0x0f) | 0x50);
  out[8] = static_cast<std::uint8_t>((out[8] & 0x3f) | 0x80);
  return out;
}

std::string
ifcGuidOf(std::string_view project, std::string_view key)
{
  const auto space = fromIfcGuid(project);
  if (space)
    return toIfcGuid(nameUuid(*space, key));
  return toIfcGuid(nameUuid(Uuid{}, std::string(project) + '\n' + std::string(key)));
}

} // namespace hoist
