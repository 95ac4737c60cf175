#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace hoist {

/** \brief FNV-1a, 64 bit: finds torn and stale records; no defence against an enemy. */
inline std::uint64_t
hashOf(std::string_view bytes)
{
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : bytes) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3u;
  }
  return hash;
}

/** \brief Sixteen digits. */
inline std::string
hexOf(std::uint64_t value)
{
  std::string text(16, '0');
  for (int i = 15; i >= 0; --i, value >>= 4)
    text[i] = "0123456789abcdef"[value & 15];
  return text;
}

} // namespace hoist
