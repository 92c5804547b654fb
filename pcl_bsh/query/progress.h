// SPDX-License-Identifier: BSD-3-Clause
// Tells the caller of a long query how far it is, and learns whether to stop.
#pragma once

#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/base/pulse.h>
#include <pcl_bsh/query/stop_rule.h>
#include <pcl_bsh/query/work.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <thread>

namespace pcl_bsh {

/// Thrown by work that cannot be left half done, when the time is over.
struct OutOfTime {};

/// While it lives, it is the Watcher of its thread: pulses of all computations there ask its report whether to go on.
/// Without a report they ask the watcher that the thread had before, if any.
class Progress final : public Watcher {
public:
  /// @param report is called in the thread that made this object, with the fraction done in [0, 1], which never falls;
  ///   false: stop
  explicit Progress(const std::function<bool(double)>& report) : report_(report) {}

  /// Begins the next part of the work. @param end fraction of the whole that is done after all steps of this part
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
    done_ += steps;
    if ((pieces_ += pieces) < kPairsOfPulse) return;
    pieces_ = 0;
    ask();
    if (limit_ && limit_->isOver()) throw OutOfTime();
  }

  /// A serial part is done. @throws Cancelled
  void end()
  {
    tell(steps_);
    throwIfStopped();
  }

  /// So much of the whole is done, and no part of it is in progress. @throws Cancelled
  void tellWhole(double share)
  {
    from_ = to_ = share;
    steps_ = 0;
    end();
  }

  /// A serial part goes on, after a step or some. @throws Cancelled
  void tellOn()
  {
    if (std::this_thread::get_id() == caller_) tell(done_);
    throwIfStopped();
  }

  /// A step that takes long goes on. @throws Cancelled
  void ask() override
  {
    if (!report_ && watched_.before())
      watched_.before()->ask();
    else if (std::this_thread::get_id() == caller_)
      tell(done_);
    throwIfStopped();
  }

  bool stopped() const { return stopped_; }

  /// All is done. @throws Cancelled
  void finish()
  {
    begin(1.0, 0);
    end();
  }

  /// @throws Cancelled, or what the report threw
  void throwIfStopped() const
  {
    if (!stopped_) return;
    if (thrown_) std::rethrow_exception(thrown_);
    throw Cancelled();
  }

private:
  void tell(std::size_t done)
  {
    if (stopped_) return;
    if (!report_) { // a query within another one: every 64 of its steps ask the other's watcher
      if ((steps_told_ += kPairsOfPulse / 64) < kPairsOfPulse || !watched_.before()) return;
      steps_told_ = 0;
      return watched_.before()->ask();
    }
    const double share = steps_ == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(steps_);
    const Watched nobody(nullptr); // a report may ask queries of its own
    try {
      if (!report_(from_ + (to_ - from_) * std::min(share, 1.0))) stopped_ = true;
    }
    catch (...) {
      thrown_ = std::current_exception();
      stopped_ = true;
      throw;
    }
  }

  const std::function<bool(double)>& report_;
  const std::thread::id caller_ = std::this_thread::get_id();
  const StopRule* limit_ = nullptr;
  std::size_t steps_ = 0, pieces_ = 0, steps_told_ = 0;
  double from_ = 0.0, to_ = 0.0; ///< fractions of the whole that are done at the beginning and end of this part
  std::atomic<std::size_t> done_{0};
  std::exception_ptr thrown_; ///< by the report; set before it has stopped
  std::atomic<bool> stopped_{false};
  const Watched watched_{this};
};

/// Who watches a search.
struct Watch {
  Progress* progress = nullptr; ///< null: nobody
  double end = 0.0;             ///< fraction of the whole that is done after the search; 0: it is part of a step
};

/// How many pairs of nodes take as long as some work.
inline std::uint64_t costInPairs(const Work& work)
{
  return work.node_pairs + 4 * work.volumes_built + 16 * work.leaf_pairs + 64 * work.exact_decisions;
}

/// Asks whether a walk shall go on, after so much of its work.
class WorkPulse {
public:
  /// @param work of the walk
  explicit WorkPulse(const Work& work) : work_(work) {}

  /// Before each small step of the walk, of a hundred pairs of nodes at most. @throws Cancelled
  void step()
  {
    if (--steps_left_ == 0) look();
  }

  /// Before a step that may take long: of two leaves, say. @throws Cancelled
  void look()
  {
    steps_left_ = kSteps;
    const std::uint64_t done = costInPairs(work_);
    if (done - asked_ < kPairsOfPulse) return;
    asked_ = done;
    askWatcher();
  }

private:
  static constexpr std::uint32_t kSteps = 64;

  const Work& work_;
  std::uint64_t asked_ = 0;
  std::uint32_t steps_left_ = kSteps;
};

/// Tells how far a depth-first search is: how many of the entries that its stack began with are done.
class SearchPulse {
public:
  /// @param size entries of the stack @param work of the search
  SearchPulse(const Watch& watch, std::size_t size, const Work& work)
  : watch_(watch),
    whole_(size),
    left_(size),
    pulse_(work)
  {
    if (watch_.progress && watch_.end > 0.0) watch_.progress->begin(watch_.end, size);
  }

  /// Before a step of the search. @throws Cancelled
  void step(std::size_t size)
  {
    if (watch_.progress && watch_.end > 0.0 && size < left_) advance(size);
    pulse_.look();
  }

private:
  /// Tells of each eighth of the whole: a small search ends before it has to ask.
  void advance(std::size_t size)
  {
    left_ = size;
    watch_.progress->skipTo(whole_ - left_);
    if (8 * (told_ - left_) < whole_) return;
    told_ = left_;
    watch_.progress->tellOn();
  }

  const Watch watch_;
  const std::size_t whole_;
  std::size_t left_, told_ = left_; ///< entries left, and entries left when it was told last
  WorkPulse pulse_;
};

} // namespace pcl_bsh
