// SPDX-License-Identifier: BSD-3-Clause
// The number of threads is an argument: one runs a plain loop, more run in oneTBB, and the results are the same.
#pragma once

#include <pcl_bsh/base/float_environment.h>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>
#include <thread>

namespace pcl_bsh {

/// @param requested 0: all of the machine's. More than the machine has would only wait for each other.
inline unsigned threadCount(unsigned requested) noexcept
{
  if (requested == 1) return 1; // the system is not asked: that takes longer than a small query
  const unsigned all = std::max(1u, std::thread::hardware_concurrency());
  return requested == 0 ? all : std::min(requested, all);
}

/// Calls body(i) for each i in [0, count), in any order; rethrows what a body throws.
template <class Body>
void parallelFor(std::size_t count, unsigned threads, const Body& body)
{
  if (threads <= 1 || count <= 1) {
    for (std::size_t i = 0; i < count; ++i) body(i);
    return;
  }
  tbb::task_arena arena(static_cast<int>(threads));
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      const DefaultFloatEnvironment environment;
      body(i);
    });
  });
}

} // namespace pcl_bsh
