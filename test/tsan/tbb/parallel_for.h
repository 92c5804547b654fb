// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tbb/task_arena.h>

#include <atomic>
#include <future>
#include <vector>

namespace tbb {

/// Calls body(i) for each i in [first, last), in any order; rethrows what a body throws. As with oneTBB, the calling
/// thread takes a share, its first piece for certain.
template <class Index, class Body>
void parallel_for(Index first, Index last, const Body& body)
{
  std::atomic<Index> next{first};
  const auto take = [&] { return next.fetch_add(1, std::memory_order_relaxed); };
  const auto work = [&](Index i) {
    for (; i < last; i = take()) body(i);
  };
  const Index own = take();
  std::vector<std::future<void>> others(static_cast<std::size_t>(task_arena::threadsHere() - 1));
  for (auto& other : others) other = std::async(std::launch::async, [&] { work(take()); });
  work(own);
  for (auto& other : others) other.get();
}

} // namespace tbb
