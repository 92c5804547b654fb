// SPDX-License-Identifier: BSD-3-Clause
// Replaces this executable's operator new by one that counts.
#include "allocations.h"

#include <algorithm>
#include <cstdlib>
#include <new>
#include <utility>

namespace {
thread_local std::size_t count = 0, largest = 0;

void note(std::size_t bytes) noexcept
{
  ++count;
  largest = std::max(largest, bytes);
}

} // namespace

void* operator new(std::size_t bytes)
{
  note(bytes);
  if (void* p = std::malloc(bytes > 0 ? bytes : 1)) return p;
  throw std::bad_alloc();
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept
{
  note(bytes);
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

std::size_t takeLargestAllocation() noexcept
{
  return std::exchange(largest, 0);
}

} // namespace pcl_bsh::test
