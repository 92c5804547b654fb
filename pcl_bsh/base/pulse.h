// SPDX-License-Identifier: BSD-3-Clause
// Every loop that can last asks now and then whether it shall go on, without knowing whom.
//
//   const Watched watched(&watcher); // a query, or a share of one on another thread
//   Pulse pulse;                     // of a loop, wherever that is
//   for (const Item& item : items) pulse.count(1), look(item);
#pragma once

#include <pcl_bsh/export.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace pcl_bsh {

/// May stop a computation, by an exception.
class Watcher {
public:
  /// Called by any thread that works for this watcher. @throws an exception that ends the work
  virtual void ask() = 0;

protected:
  ~Watcher() = default;
};

/// The watcher that this thread works for, or null.
PCL_BSH_EXPORT_INTERNAL Watcher* watcherOfThread() noexcept;

/// Asks this thread's watcher, if it has one. @throws the watcher's exception, which ends the work
inline void askWatcher()
{
  if (Watcher* const watcher = watcherOfThread()) watcher->ask();
}

/// While it lives, its thread works for this watcher. Objects of one thread must end in the reverse order of their
/// beginning.
class PCL_BSH_EXPORT_INTERNAL Watched {
public:
  explicit Watched(Watcher* watcher) noexcept;
  ~Watched();
  Watched(const Watched&) = delete;
  Watched& operator=(const Watched&) = delete;

  /// The watcher that the thread worked for before.
  Watcher* before() const noexcept { return before_; }

private:
  Watcher* const before_;
};

/// Pairs of nodes, or work that takes as long, between two questions to the watcher. They take 16 ms where a pair takes
/// a microsecond, as pairs of triangles do.
inline constexpr std::uint64_t kPairsOfPulse = std::uint64_t{1} << 14;

/// Counts the work of a loop, and asks the watcher each time kPairsOfPulse are reached.
class Pulse {
public:
  /// Adds work, before or after it is done. @param pairs of nodes, or work that takes as long. @throws as askWatcher()
  void count(std::uint64_t pairs)
  {
    if ((pairs_ += pairs) < kPairsOfPulse) return;
    pairs_ = 0;
    askWatcher();
  }

private:
  std::uint64_t pairs_ = 0;
};

/// Waits until `changed` is notified. With a watcher it waits for 10 ms at most, and then asks it. @param lock held,
/// but released while it asks
inline void waitAsking(std::condition_variable& changed, std::unique_lock<std::mutex>& lock)
{
  if (!watcherOfThread()) return changed.wait(lock);
  if (changed.wait_for(lock, std::chrono::milliseconds(10)) == std::cv_status::no_timeout) return;
  struct Unlocked {
    explicit Unlocked(std::unique_lock<std::mutex>& held) : lock(held) { lock.unlock(); }
    ~Unlocked() { lock.lock(); }
    std::unique_lock<std::mutex>& lock;
  };
  const Unlocked unlocked(lock);
  askWatcher();
}

} // namespace pcl_bsh
