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

  /// All is done. @throws Cancelled
  void finish()
  {
    begin(1.0, 0);
    end();
  }

  /// For a query that is one step of this work, or part of one, in any thread: it tells nothing of how far it is, and
  /// is stopped with the whole.
  std::function<bool(double)> nested()
  {
    if (!report_) return {};
    return [this](double) { return !pulse(); };
  }

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

/// Who watches a search.
struct Watch {
  Progress* progress = nullptr; ///< null: nobody
  double end = 0.0;             ///< what the search takes the whole to; 0: it is part of a step
};

/// Tells how far a depth-first search is: how many of the entries that its stack began with are done.
class SearchPulse {
public:
  /// @param size entries of the stack
  SearchPulse(const Watch& watch, std::size_t size) : watch_(watch), whole_(size), left_(size)
  {
    if (watch_.progress && watch_.end > 0.0) watch_.progress->begin(watch_.end, size);
  }

  /// Before a step of the search. @throws Cancelled
  void step(std::size_t size)
  {
    if (!watch_.progress) return;
    left_ = std::min(left_, size);
    if (++steps_ % 64 == 0) tell(); // a clock, which most callers look at, costs as much as a step
  }

private:
  void tell()
  {
    if (watch_.end > 0.0) watch_.progress->skipTo(whole_ - left_);
    if (watch_.progress->pulse()) throw Cancelled();
  }

  const Watch watch_;
  const std::size_t whole_;
  std::size_t left_;
  unsigned steps_ = 0;
};

} // namespace pcl_bsh
