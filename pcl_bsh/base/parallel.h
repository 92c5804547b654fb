// SPDX-License-Identifier: BSD-3-Clause
// The number of threads is an argument: one runs a plain loop, more run in oneTBB, and the results are the same.
#pragma once

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/pulse.h>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <thread>

namespace pcl_bsh {

/// The number of threads to use: at most as many as the machine has, since more would only wait for each other.
/// @param requested 0: all of the machine's
inline unsigned threadCount(unsigned requested) noexcept
{
  if (requested == 1) return 1; // the system is not asked: that takes longer than a small query
  const unsigned all = std::max(1u, std::thread::hardware_concurrency());
  return requested == 0 ? all : std::min(requested, all);
}

/// The entries of a loop that several threads share.
template <class Body>
class SharedLoop {
public:
  SharedLoop(std::size_t count, const Body& body) : count_(count), body_(body) {}

  /// Does one entry after another until none is left. The calling thread then asks its watcher while others work.
  void share()
  {
    const DefaultFloatEnvironment environment;
    const Watched watched(watcher_);
    ++busy_;
    try {
      for (std::size_t i; (i = next_.fetch_add(1, std::memory_order_relaxed)) < count_;) body_(i);
    }
    catch (...) {
      next_ = count_; // the rest is of no use
      leave();
      throw;
    }
    leave();
    if (!watcher_ || std::this_thread::get_id() != caller_) return;
    std::unique_lock<std::mutex> lock(mutex_);
    while (busy_ != 0) waitAsking(done_, lock);
  }

private:
  void leave()
  {
    if (--busy_ != 0) return;
    const std::lock_guard<std::mutex> lock(mutex_);
    done_.notify_all();
  }

  const std::size_t count_;
  const Body& body_;
  Watcher* const watcher_ = watcherOfThread();
  const std::thread::id caller_ = std::this_thread::get_id();
  std::atomic<std::size_t> next_{0}, busy_{0};
  std::mutex mutex_;
  std::condition_variable done_;
};

/// Calls body(i) for each i in [0, count), in any order; rethrows what a body throws. Bodies on other threads have the
/// watcher of this thread. It is asked, too, while this thread only waits for them.
template <class Body>
void parallelFor(std::size_t count, unsigned threads, const Body& body)
{
  if (threads <= 1 || count <= 1) {
    for (std::size_t i = 0; i < count; ++i) body(i);
    return;
  }
  SharedLoop<Body> loop(count, body);
  tbb::task_arena arena(static_cast<int>(threads));
  arena.execute([&] { tbb::parallel_for(0u, threads, [&](unsigned) { loop.share(); }); });
}

} // namespace pcl_bsh
