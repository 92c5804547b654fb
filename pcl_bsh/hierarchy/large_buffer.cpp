// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/hierarchy/large_buffer.h>

#include <algorithm>
#include <cstdlib>
#include <mutex>
#include <new>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace pcl_bsh {
namespace {

constexpr std::size_t kHugePage = std::size_t{1} << 21;
constexpr std::size_t kVector = 64;

#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__)
constexpr std::size_t kKept = kKeptBytes;
#else
constexpr std::size_t kKept = 0; // without a word to the system, or where use after free is to be found
#endif

/// Whether a buffer is large enough for huge pages, and to be kept.
bool isLarge(std::size_t bytes)
{
  return bytes >= 2 * kHugePage;
}

/// Large buffers that nobody uses, the oldest first.
class KeptBuffers {
public:
  /// The smallest that holds `size` bytes and is not twice as large, the youngest of these; null when there is none.
  AllocatedBuffer take(std::size_t size)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    auto best = kept_.end();
    for (auto it = kept_.begin(); it != kept_.end(); ++it)
      if (it->size >= size && it->size < 2 * size && (best == kept_.end() || it->size <= best->size)) best = it;
    if (best == kept_.end()) return {nullptr, 0};
    const AllocatedBuffer buffer = *best;
    kept_.erase(best);
    total_ -= buffer.size;
    return buffer;
  }

  /// Frees the oldest ones for it, or itself when it is larger than all that may be kept.
  void give(const AllocatedBuffer& buffer) noexcept
  {
    if (buffer.size > kKept) return std::free(buffer.p);
    const std::lock_guard<std::mutex> lock(mutex_);
    auto first = kept_.begin();
    for (; total_ + buffer.size > kKept; ++first) {
      total_ -= first->size;
      std::free(first->p);
    }
    kept_.erase(kept_.begin(), first);
#ifdef MADV_FREE
    madvise(buffer.p, buffer.size, MADV_FREE); // under pressure, the system may have the pages
#endif
    kept_.push_back(buffer);
    total_ += buffer.size;
  }

  std::size_t total()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    return total_;
  }

  /// Never destroyed: buffers may outlive whatever this file could order.
  static KeptBuffers& instance()
  {
    static auto* const buffers = new KeptBuffers;
    return *buffers;
  }

private:
  KeptBuffers()
  {
    kept_.reserve(kKept / (2 * kHugePage));
  }

  std::mutex mutex_;
  std::vector<AllocatedBuffer> kept_; // has room for all that may be, so that give() does not allocate
  std::size_t total_ = 0;
};

} // namespace

AllocatedBuffer allocateBuffer(std::size_t bytes)
{
  const bool large = isLarge(bytes + kVector); // some less than it would be rounded up to a large one
  const std::size_t alignment = large ? kHugePage : kVector;
  const std::size_t size = std::max(alignment, (bytes + alignment - 1) / alignment * alignment);
  if (large)
    if (const AllocatedBuffer kept = KeptBuffers::instance().take(size); kept.p) return kept;
  void* const p = std::aligned_alloc(alignment, size);
  if (!p) throw std::bad_alloc();
#ifdef __linux__
  if (large) madvise(p, size, MADV_HUGEPAGE);
#endif
  return {p, size};
}

std::size_t keptBytes()
{
  return KeptBuffers::instance().total();
}

void FreeBuffer::operator()(void* p) const noexcept
{
  if (isLarge(size))
    KeptBuffers::instance().give({p, size});
  else
    std::free(p);
}

} // namespace pcl_bsh
