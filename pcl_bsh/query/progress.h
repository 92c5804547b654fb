// SPDX-License-Identifier: BSD-3-Clause
// Tells the caller of a long query how far it is, and learns whether to stop.
#pragma once

#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/query/stop_rule.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>
#include <thread>

namespace pcl_bsh {

/// What a part of the work that cannot be left half done throws when the time is over.
struct OutOfTime {};

class Progress {
public:
  /// @param report is called in the thread that made this object, with the fraction done in [0, 1], which never falls;
  ///   false: stop
  explicit Progress(const std::function<bool(double)>& report) : report_(report) {}

  /// Begins the next part of the work: all of its steps together take the whole to this fraction.
  void begin(double end, std::size_t steps)
  {
    from_ = to_;
    to_ = end;
    steps_ = steps;
    done_ = 0;
  }

  /// From now on, tick() throws OutOfTime once the rule's time is over; none: never.
  void limit(const StopRule* rule) { limit_ = rule; }

  /// So many steps of this part are done, or need not be.
  void skipTo(std::size_t done) { done_ = done; }

  /// A step is done, in any thread.
  void step()
  {
    const std::size_t done = ++done_;
    if (std::this_thread::get_id() == caller_) tell(done);
  }

  /// Counts small pieces of work of a serial part; after many of them, reports that it goes on.
  /// @param steps whole ones among them. @throws Cancelled, OutOfTime
  void tick(std::size_t pieces, std::size_t steps = 0)
  {
    constexpr std::size_t many = std::size_t{1} << 15;
    done_ += steps;
    if ((pieces_ += pieces) < many) return;
    pieces_ = 0;
    tell(done_);
    throwIfStopped();
    if (limit_ && limit_->isOver()) throw OutOfTime();
  }

  /// A serial part is done. @throws Cancelled
  void end()
  {
    tell(steps_);
    throwIfStopped();
  }

  /// In any thread: a step that takes long goes on. @return whether to stop
  bool pulse()
  {
    if (std::this_thread::get_id() == caller_) tell(done_);
    return stopped_;
  }

  bool stopped() const { return stopped_; }

  void throwIfStopped() const
  {
    if (stopped_) throw Cancelled();
  }

private:
  void tell(std::size_t done)
  {
    const double share = steps_ == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(steps_);
    if (report_ && !stopped_ && !report_(from_ + (to_ - from_) * std::min(share, 1.0))) stopped_ = true;
  }

  const std::function<bool(double)>& report_;
  const std::thread::id caller_ = std::this_thread::get_id();
  const StopRule* limit_ = nullptr;
  std::size_t steps_ = 0, pieces_ = 0;
  double from_ = 0.0, to_ = 0.0; ///< of this part: what its first and its last step take the whole to
  std::atomic<std::size_t> done_{0};
  std::atomic<bool> stopped_{false};
};

} // namespace pcl_bsh
