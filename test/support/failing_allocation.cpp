// SPDX-License-Identifier: BSD-3-Clause
#include "failing_allocation.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<bool> armed{false}, happened{false}, lasting{false};
std::atomic<std::size_t> fails{0}, counted{0};
std::atomic<std::ptrdiff_t> live{0};

bool mayAllocate() noexcept
{
  if (!armed.load(std::memory_order_relaxed)) return true;
  const std::size_t number = ++counted;
  const std::size_t fatal = fails.load(std::memory_order_relaxed);
  const bool fatal_now = fatal != 0 && (number == fatal || (number > fatal && lasting.load(std::memory_order_relaxed)));
  if (fatal_now) happened = true;
  return !fatal_now;
}

void* allocate(std::size_t bytes, std::size_t alignment) noexcept
{
  if (!mayAllocate()) return nullptr;
  if (bytes == 0) bytes = 1;
  void* const p = alignment <= alignof(std::max_align_t)
                      ? std::malloc(bytes)
                      : std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
  if (p) ++live;
  return p;
}

void release(void* p) noexcept
{
  if (p) --live;
  std::free(p);
}

} // namespace

void* operator new(std::size_t bytes)
{
  if (void* const p = allocate(bytes, 0)) return p;
  throw std::bad_alloc();
}
void* operator new(std::size_t bytes, std::align_val_t alignment)
{
  if (void* const p = allocate(bytes, static_cast<std::size_t>(alignment))) return p;
  throw std::bad_alloc();
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept
{
  return allocate(bytes, 0);
}
void* operator new(std::size_t bytes, std::align_val_t alignment, const std::nothrow_t&) noexcept
{
  return allocate(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* p) noexcept
{
  release(p);
}
void operator delete(void* p, std::size_t) noexcept
{
  release(p);
}
void operator delete(void* p, std::align_val_t) noexcept
{
  release(p);
}
void operator delete(void* p, std::size_t, std::align_val_t) noexcept
{
  release(p);
}

namespace pcl_bsh::test {

FailingAllocation::FailingAllocation(std::size_t k, Shortage shortage) noexcept
{
  fails = k;
  lasting = shortage == Shortage::lasting;
  counted = 0;
  happened = false;
  armed = true;
}
FailingAllocation::~FailingAllocation()
{
  armed = false;
}
bool FailingAllocation::hasHappened() const noexcept
{
  return happened;
}
std::size_t FailingAllocation::allocations() const noexcept
{
  return counted;
}
std::ptrdiff_t liveAllocations() noexcept
{
  return live;
}

} // namespace pcl_bsh::test
