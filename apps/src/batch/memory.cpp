#include "batch/memory.h"

#include "failures.h"

#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <unistd.h>

namespace hoist {
namespace {

constexpr std::uint64_t mega = 1024 * 1024;

// The batch itself: results that wait to be written, and the pages of the libraries,
// which the workers share with it; and what a file's names take (300 bytes measured).
constexpr std::uint64_t own_base = 256 * mega;
constexpr std::uint64_t own_per_file = 512;

// A worker that has loaded the program and recognises 640 x 480 pixels takes half.
constexpr std::uint64_t smallest_share = 192 * mega;

} // namespace

std::uint64_t
parseMemory(const std::string& text)
{
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  std::string unit(rest, end);
  if (!unit.empty() && (unit.back() == 'B' || unit.back() == 'b'))
    unit.pop_back();
  double factor = 0;
  if (unit.empty())
    factor = 1;
  else if (unit.size() == 1) {
    const std::size_t power = std::string("KMGT").find(
        static_cast<char>(unit[0] >= 'a' ? unit[0] - 'a' + 'A' : unit[0]));
    for (std::size_t i = 0; power != std::string::npos && i <= power; ++i)
      factor = factor == 0 ? 1024 : factor * 1024;
  }
  if (error != std::errc() || factor == 0 || !(number > 0) || number * factor > 1e18)
    throw CLI::ValidationError(
        "--memory", "'" + text + "' is not an amount of memory, e.g. 800M or 4G");
  return static_cast<std::uint64_t>(number * factor);
}

std::string
memoryText(std::uint64_t bytes)
{
  const double megas = static_cast<double>(bytes) / mega;
  if (megas >= 1024)
    return fmt::format("{:.4g} GB", megas / 1024);
  return fmt::format("{:.4g} MB", megas);
}

std::uint64_t
defaultMemory()
{
  std::uint64_t bytes = static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
                        static_cast<std::uint64_t>(::sysconf(_SC_PAGE_SIZE));
  std::uint64_t limit = 0;
  if (std::ifstream("/sys/fs/cgroup/memory.max") >> limit) // "max" is no number
    bytes = std::min(bytes, limit);
  return bytes / 4 * 3;
}

MemoryPlan
planMemory(std::uint64_t memory, std::size_t workers, std::size_t files)
{
  const std::uint64_t own = own_base + own_per_file * files;
  if (memory < own + smallest_share)
    throw UsageError("--memory " + memoryText(memory) + " is less than the " +
                     memoryText(own + smallest_share) + " that one worker needs");
  const std::uint64_t rest = memory - own;
  const std::size_t possible = std::min<std::uint64_t>(workers, rest / smallest_share);
  return {possible, rest / possible, rest};
}

} // namespace hoist
