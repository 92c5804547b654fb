// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/large_buffer.h>

#include <algorithm>
#include <limits>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace pcl_bsh {
namespace {

constexpr std::size_t kHugePage = std::size_t{1} << 21;
constexpr std::size_t kLeastKept = std::size_t{1} << 18;
constexpr std::size_t kVector = 64;
constexpr std::size_t kMostBytes = std::numeric_limits<std::ptrdiff_t>::max() - kHugePage;

#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__)
constexpr bool kKeeps = true;
#else
constexpr bool kKeeps = false; // pages cannot be offered to the system, or AddressSanitizer looks for uses after free
#endif

bool hasHugePages(std::size_t bytes)
{
  return bytes >= 2 * kHugePage;
}

bool isKept(std::size_t bytes)
{
  return kKeeps && bytes >= kLeastKept;
}

std::align_val_t alignmentOf(std::size_t bytes)
{
  return std::align_val_t{hasHugePages(bytes) ? kHugePage : kVector};
}

} // namespace

AllocatedBuffer allocateBuffer(std::size_t bytes)
{
  if (bytes > kMostBytes) throw std::bad_alloc();
  const bool huge = hasHugePages(bytes + kVector); // a size just below the limit would be rounded up to it
  const std::size_t alignment = huge ? kHugePage : kVector;
  const std::size_t size = std::max(alignment, (bytes + alignment - 1) / alignment * alignment);
  if (isKept(size))
    if (const AllocatedBuffer kept = takeKeptBuffer(size); kept.p) return kept;
  void* const p = ::operator new(size, alignmentOf(size));
#ifdef __linux__
  if (huge) madvise(p, size, MADV_HUGEPAGE);
#endif
  return {p, size};
}

void freeBuffer(const AllocatedBuffer& buffer) noexcept
{
  ::operator delete(buffer.p, buffer.size, alignmentOf(buffer.size));
}

void FreeBuffer::operator()(void* p) const noexcept
{
  if (isKept(size))
    keepBuffer({p, size});
  else
    freeBuffer({p, size});
}

} // namespace pcl_bsh
