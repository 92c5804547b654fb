// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tbb/task_arena.h>

#include <atomic>
#include <future>
#include <vector>

namespace tbb {

/// Calls body(i) for each i in [first, last), in any order; rethrows what a body throws.
template <class Index, class Body>
void parallel_for(Index first, Index last, const Body& body)
{
  std::atomic<Index> next{first};
  std::vector<std::future<void>> threads(static_cast<std::size_t>(task_arena::threadsHere()));
  for (auto& thread : threads) {
    thread = std::async(std::launch::async, [&] {
      for (Index i; (i = next.fetch_add(1, std::memory_order_relaxed)) < last;) body(i);
    });
  }
  for (auto& thread : threads) thread.get();
}

} // namespace tbb
