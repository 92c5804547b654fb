// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/retained_memory.h>

#include <pcl_bsh/base/kept_scratch.h>
#include <pcl_bsh/base/large_buffer.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <type_traits>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace pcl_bsh {

/// It never allocates, because it is needed where memory has run out. It is never destroyed, because threads and
/// buffers may outlive static objects.
class RetainedMemory {
public:
  constexpr RetainedMemory() = default;

  std::size_t bytes() const noexcept { return bytes_.load(std::memory_order_relaxed); }
  std::size_t limit() const noexcept { return limit_.load(std::memory_order_relaxed); }

  AllocatedBuffer take(std::size_t size) noexcept
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    AllocatedBuffer* const end = buffers_.data() + buffer_count_;
    AllocatedBuffer* best = end;
    for (AllocatedBuffer* it = buffers_.data(); it != end; ++it)
      if (it->size >= size && it->size < 2 * size && (best == end || it->size <= best->size)) best = it;
    if (best == end) return {nullptr, 0};
    const AllocatedBuffer buffer = *best;
    std::copy(best + 1, end, best);
    --buffer_count_;
    bytes_ -= buffer.size;
    return buffer;
  }

  void keep(const AllocatedBuffer& buffer) noexcept
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (buffer.size > limit()) return freeBuffer(buffer);
    dropBuffers(limit() - buffer.size, kMostBuffers - 1);
    if (bytes() > limit() - buffer.size) return freeBuffer(buffer); // scratch takes up the limit
#ifdef MADV_FREE
    madvise(buffer.p, buffer.size, MADV_FREE); // under pressure, the system may have the pages
#endif
    buffers_[buffer_count_++] = buffer;
    bytes_ += buffer.size;
  }

  void enter(ScratchSlot& slot) noexcept
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    slot.next_ = first_slot_;
    if (first_slot_) first_slot_->previous_ = &slot;
    first_slot_ = &slot;
  }

  void leave(ScratchSlot& slot) noexcept
  {
    KeptScratch* left = nullptr;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      (slot.previous_ ? slot.previous_->next_ : first_slot_) = slot.next_;
      if (slot.next_) slot.next_->previous_ = slot.previous_;
      collect(slot, left);
    }
    deleteAll(left);
  }

  /// Counts scratch, which now holds `bytes`, as retained if it may be kept. @return whether it may be kept
  bool keeps(KeptScratch& scratch, std::size_t bytes) noexcept
  {
    constexpr std::size_t kMostScratch = std::size_t{16} << 20; // beyond, a few allocations more are not noticed
    const std::lock_guard<std::mutex> lock(mutex_);
    bytes_ -= scratch.bytes;
    scratch.bytes = 0;
    if (bytes > kMostScratch || bytes > limit() || this->bytes() > limit() - bytes) return false;
    bytes_ += bytes;
    scratch.bytes = bytes;
    return true;
  }

  void shrinkTo(std::size_t most) noexcept
  {
    KeptScratch* left = nullptr;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      dropBuffers(most, kMostBuffers);
      for (ScratchSlot* slot = first_slot_; slot && bytes() > most; slot = slot->next_) collect(*slot, left);
    }
    deleteAll(left);
    const std::lock_guard<std::mutex> lock(mutex_);
    dropBuffers(most, kMostBuffers); // the buffers that the deleted scratch has given back
  }

  void setLimit(std::size_t bytes) noexcept
  {
    limit_ = bytes;
    shrinkTo(bytes);
  }

private:
  static constexpr std::size_t kMostBuffers = 256;

  /// Gives back the oldest buffers until no more than `most` bytes are kept, and `count` buffers.
  void dropBuffers(std::size_t most, std::size_t count) noexcept
  {
    std::size_t dropped = 0;
    for (; dropped < buffer_count_ && (bytes() > most || buffer_count_ - dropped > count); ++dropped) {
      bytes_ -= buffers_[dropped].size;
      freeBuffer(buffers_[dropped]);
    }
    std::copy(buffers_.begin() + dropped, buffers_.begin() + buffer_count_, buffers_.begin());
    buffer_count_ -= dropped;
  }

  /// Moves a slot's scratch to the front of a list. The list must be deleted after the mutex is unlocked, because the
  /// scratch gives its large buffers to this object.
  void collect(ScratchSlot& slot, KeptScratch*& list) noexcept
  {
    KeptScratch* const scratch = slot.take();
    if (!scratch) return;
    bytes_ -= scratch->bytes;
    scratch->next = list;
    list = scratch;
  }

  static void deleteAll(KeptScratch* list) noexcept
  {
    while (list) {
      KeptScratch* const next = list->next;
      delete list;
      list = next;
    }
  }

  std::mutex mutex_;                                    ///< of the buffers and of the list of slots
  std::array<AllocatedBuffer, kMostBuffers> buffers_{}; ///< the oldest first
  std::size_t buffer_count_ = 0;
  ScratchSlot* first_slot_ = nullptr;
  std::atomic<std::size_t> bytes_{0};
  std::atomic<std::size_t> limit_{std::size_t{256} << 20};
};

namespace {
constinit RetainedMemory retained;
static_assert(std::is_trivially_destructible_v<RetainedMemory>);
} // namespace

ScratchSlot::ScratchSlot() noexcept
{
  retained.enter(*this);
}

ScratchSlot::~ScratchSlot()
{
  retained.leave(*this);
}

bool ScratchSlot::isOverLimit() noexcept
{
  return retained.bytes() > retained.limit();
}

void ScratchSlot::settle(KeptScratch* scratch, std::size_t bytes) noexcept
{
  const bool is_first = idle_.load(std::memory_order_relaxed) == nullptr;
  if (retained.keeps(*scratch, is_first ? bytes : ~std::size_t{0}))
    idle_.store(scratch, std::memory_order_release);
  else
    delete scratch;
}

AllocatedBuffer takeKeptBuffer(std::size_t size) noexcept
{
  return retained.take(size);
}
void keepBuffer(const AllocatedBuffer& buffer) noexcept
{
  retained.keep(buffer);
}

std::size_t retainedMemory() noexcept
{
  return retained.bytes();
}
std::size_t retainedMemoryLimit() noexcept
{
  return retained.limit();
}
void setRetainedMemoryLimit(std::size_t bytes) noexcept
{
  retained.setLimit(bytes);
}
void releaseRetainedMemory() noexcept
{
  retained.shrinkTo(0);
}

} // namespace pcl_bsh
