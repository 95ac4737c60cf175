// Counts what is taken from the heap through operator new, by replacing it.
#include "allocations.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::size_t> count{0};

} // namespace

void*
operator new(std::size_t size)
{
  ++count;
  void* memory = std::malloc(size > 0 ? size : 1);
  if (memory == nullptr)
    throw std::bad_alloc();
  return memory;
}

// Sorting takes its scratch memory with this one; AddressSanitizer would answer it with
// its own, which std::free() does not take back.
void*
operator new(std::size_t size, const std::nothrow_t&) noexcept
{
  ++count;
  return std::malloc(size > 0 ? size : 1);
}

void
operator delete(void* memory) noexcept
{
  std::free(memory);
}

void
operator delete(void* memory, std::size_t) noexcept
{
  std::free(memory);
}

namespace hoist {
namespace test {

std::size_t
allocations()
{
  return count;
}

} // namespace test
} // namespace hoist
