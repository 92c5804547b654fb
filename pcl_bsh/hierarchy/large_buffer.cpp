// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/hierarchy/large_buffer.h>

#include <cstdlib>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace pcl_bsh {
namespace {

constexpr std::size_t kHugePage = std::size_t{1} << 21;
constexpr std::size_t kVector = 64;

} // namespace

void FreeBuffer::operator()(void* p) const noexcept
{
  std::free(p);
}

void* allocateBuffer(std::size_t bytes)
{
  const bool huge = bytes >= 2 * kHugePage;
  const std::size_t alignment = huge ? kHugePage : kVector;
  void* p =
      std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment + (bytes == 0 ? alignment : 0));
  if (!p) throw std::bad_alloc();
#ifdef __linux__
  if (huge) madvise(p, bytes, MADV_HUGEPAGE);
#endif
  return p;
}

} // namespace pcl_bsh
