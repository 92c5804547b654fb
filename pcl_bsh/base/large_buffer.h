// SPDX-License-Identifier: BSD-3-Clause
// Memory for points: large buffers, which are kept for the next hierarchy when one ends. kept_scratch.h keeps the
// scratch memory of threads; retained_memory.h has the limit for both, and gives both back.
#pragma once

#include <cstddef>
#include <memory>

namespace pcl_bsh {

struct FreeBuffer {
  std::size_t size = 0; ///< bytes that were allocated

  void operator()(void* p) const noexcept;
};

/// Uninitialised storage. Buffers of 256 KB and more are kept when they are freed, within the limit of
/// retained_memory.h; those of 4 MB and more ask the system for huge pages. A page's first touch would cost more than
/// sorting the points that go there, most of all on a virtual machine.
template <class T>
using LargeBuffer = std::unique_ptr<T[], FreeBuffer>;

struct AllocatedBuffer {
  void* p;
  std::size_t size; ///< at least what was asked for
};

/// A kept one, or one of operator new. @throws std::bad_alloc
AllocatedBuffer allocateBuffer(std::size_t bytes);

/// Gives it back to the system.
void freeBuffer(const AllocatedBuffer& buffer) noexcept;

/// Takes the smallest kept buffer that holds `size` bytes and is not twice as large, the youngest of equal ones; null
/// where no buffer fits.
AllocatedBuffer takeKeptBuffer(std::size_t size) noexcept;

/// Keeps a buffer within the limit of retained_memory.h: frees the oldest buffers to make room for it. Frees the buffer
/// itself where that makes too little room.
void keepBuffer(const AllocatedBuffer& buffer) noexcept;

/// @throws std::bad_alloc
template <class T>
LargeBuffer<T> makeBuffer(std::size_t count)
{
  const AllocatedBuffer buffer = allocateBuffer(count * sizeof(T));
  return LargeBuffer<T>(static_cast<T*>(buffer.p), FreeBuffer{buffer.size});
}

} // namespace pcl_bsh
