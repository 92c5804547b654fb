// SPDX-License-Identifier: BSD-3-Clause
// Scratch memory of queries and of building, which each thread keeps from one use to the next. retained_memory.h has
// the limit for it and for the buffers of large_buffer.h, and gives both back.
#pragma once

#include <atomic>
#include <cstddef>

namespace pcl_bsh {

/// Scratch memory of one kind, of one thread.
struct KeptScratch {
  virtual ~KeptScratch() = default;

  std::size_t bytes = 0;       ///< of it, as counted among the retained memory
  KeptScratch* next = nullptr; ///< in a list of those to be deleted
};

/// Holds a thread's scratch of one kind between two uses. Other threads may take it from here to free it.
class ScratchSlot {
public:
  ScratchSlot() noexcept;
  ~ScratchSlot(); ///< a thread that ends keeps nothing
  ScratchSlot(const ScratchSlot&) = delete;
  ScratchSlot& operator=(const ScratchSlot&) = delete;

  /// Takes the scratch that lies here, null without one; the slot's own thread calls it.
  KeptScratch* take() noexcept { return idle_.exchange(nullptr, std::memory_order_acquire); }

  /// Keeps the scratch, which now holds `bytes`, for the next take(). Deletes it where it holds more than 16 MB, where
  /// the limit of retained memory would be exceeded, or where the slot has one already. While its size stays the same,
  /// nothing that threads share is written.
  void give(KeptScratch* scratch, std::size_t bytes) noexcept
  {
    if (bytes != scratch->bytes || isOverLimit() || idle_.load(std::memory_order_relaxed))
      settle(scratch, bytes);
    else
      idle_.store(scratch, std::memory_order_release);
  }

private:
  friend class RetainedMemory;

  static bool isOverLimit() noexcept;
  void settle(KeptScratch* scratch, std::size_t bytes) noexcept;

  std::atomic<KeptScratch*> idle_{nullptr}; ///< only its own thread makes it other than null
  ScratchSlot* previous_ = nullptr;
  ScratchSlot* next_ = nullptr;
};

/// Lends a T to one thread for the lifetime of the lease: the T of the last lease on this thread, or a new one.
/// T::bytes() is the memory that it holds.
template <class T>
class ScratchLease {
public:
  ScratchLease() : slot_(slotOfThisThread()), held_(static_cast<Held*>(slot_.take()))
  {
    if (!held_) held_ = new Held;
  }
  ~ScratchLease() { slot_.give(held_, sizeof(Held) + held_->value.bytes()); }
  ScratchLease(const ScratchLease&) = delete;
  ScratchLease& operator=(const ScratchLease&) = delete;

  T& operator*() const noexcept { return held_->value; }

private:
  struct Held : KeptScratch {
    T value;
  };

  static ScratchSlot& slotOfThisThread() noexcept
  {
    thread_local ScratchSlot slot;
    return slot;
  }

  ScratchSlot& slot_;
  Held* held_;
};

} // namespace pcl_bsh
