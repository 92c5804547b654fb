// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>

namespace pcl_bsh {

struct FreeBuffer {
  void operator()(void* p) const noexcept;
};

/// Uninitialised storage. Large ones ask the system for huge pages, where it has them: first touches of small pages
/// would cost as much as sorting the points that go there.
template <class T>
using LargeBuffer = std::unique_ptr<T[], FreeBuffer>;

void* allocateBuffer(std::size_t bytes);

/// @throws std::bad_alloc
template <class T>
LargeBuffer<T> makeBuffer(std::size_t count)
{
  return LargeBuffer<T>(static_cast<T*>(allocateBuffer(count * sizeof(T))));
}

} // namespace pcl_bsh
