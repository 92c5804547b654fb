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

/// Who may end what is computed.
class Watcher {
public:
  /// From any thread that works for it. @throws what ends the work
  virtual void ask() = 0;

protected:
  ~Watcher() = default;
};

/// The one that this thread works for; null: nobody.
PCL_BSH_EXPORT_INTERNAL Watcher* watcherOfThread() noexcept;

/// Asks the one that this thread works for. @throws what ends the work
inline void askWatcher()
{
  if (Watcher* const watcher = watcherOfThread()) watcher->ask();
}

/// While it lives, its thread works for this watcher. To be ended in the reverse order of their beginning.
class PCL_BSH_EXPORT_INTERNAL Watched {
public:
  explicit Watched(Watcher* watcher) noexcept;
  ~Watched();
  Watched(const Watched&) = delete;
  Watched& operator=(const Watched&) = delete;

  /// The one that the thread works for otherwise.
  Watcher* before() const noexcept { return before_; }

private:
  Watcher* const before_;
};

/// Pairs of nodes between two questions, or what takes as long: 16 ms where each takes a microsecond, as pairs of
/// triangles do.
inline constexpr std::uint64_t kPairsOfPulse = std::uint64_t{1} << 14;

/// Counts what a loop does, and asks after so much of it.
class Pulse {
public:
  /// Before or after so many pairs of nodes, or what takes as long. @throws what ends the work
  void count(std::uint64_t pairs)
  {
    if ((pairs_ += pairs) < kPairsOfPulse) return;
    pairs_ = 0;
    askWatcher();
  }

private:
  std::uint64_t pairs_ = 0;
};

/// Waits until it is notified, or for a moment after which it asks. @param lock held, but not while it asks
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
