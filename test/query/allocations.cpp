// SPDX-License-Identifier: BSD-3-Clause
// Replaces this executable's operator new by one that counts.
#include "allocations.h"

#include <cstdlib>
#include <new>

namespace {
thread_local std::size_t count = 0;
} // namespace

void* operator new(std::size_t bytes)
{
  ++count;
  if (void* p = std::malloc(bytes > 0 ? bytes : 1)) return p;
  throw std::bad_alloc();
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept
{
  ++count;
  return std::malloc(bytes > 0 ? bytes : 1);
}
void operator delete(void* p) noexcept
{
  std::free(p);
}
void operator delete(void* p, std::size_t) noexcept
{
  std::free(p);
}

namespace pcl_bsh::test {

std::size_t allocations() noexcept
{
  return count;
}

} // namespace pcl_bsh::test
