// SPDX-License-Identifier: BSD-3-Clause
// When a walk stops before all is decided.
#pragma once

#include <pcl_bsh/query/accuracy.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace pcl_bsh {

class StopRule {
public:
  using Clock = std::chrono::steady_clock;

  explicit StopRule(const Accuracy& accuracy) : may_stop_(accuracy.stopsEarly())
  {
    const std::uint64_t count = accuracy.value < 0x1p63 ? static_cast<std::uint64_t>(accuracy.value) : kNever;
    if (accuracy.mode == Accuracy::Mode::level) deepest = count;
    if (accuracy.mode == Accuracy::Mode::node_pairs) node_pairs = count;
    if (accuracy.mode == Accuracy::Mode::time) {
      constexpr double year = 86400.0 * 365; // more would overflow the clock
      const std::chrono::duration<double> seconds(std::min(accuracy.value, year));
      deadline_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(seconds);
    }
  }

  static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

  std::uint64_t deepest = kNever;    ///< level below the voxels whose nodes are not opened
  std::uint64_t node_pairs = kNever; ///< sphere tests that may be spent

  bool mayStop() const noexcept { return may_stop_; }
  bool isTimed() const noexcept { return deadline_ != Clock::time_point::max(); }
  bool isOver() const { return isTimed() && Clock::now() >= deadline_; }
  Clock::duration timeLeft(Clock::time_point now) const { return deadline_ - now; } ///< @pre isTimed()
  bool isSpent(std::uint64_t tested) const { return tested >= node_pairs || isOver(); }

  /// Whether so many points can be built into trees before the time is over. Work that is not begun cannot overrun.
  bool leavesTimeToBuild(std::size_t points) const
  {
    constexpr double seconds_per_point = 60e-9; // a generous figure
    return !isTimed() ||
           Clock::now() + std::chrono::duration<double>(seconds_per_point * static_cast<double>(points)) < deadline_;
  }

  /// Whether a walk may go below voxels, and has the time to build them. @param points() how many are to be built
  template <class Points>
  bool mayEnter(const Points& points) const
  {
    return deepest > 0 && (!isTimed() || leavesTimeToBuild(points()));
  }

  /// The rule with this share of the time that is left, or of the sphere tests.
  StopRule part(double share) const
  {
    StopRule rule = *this;
    if (isTimed()) {
      const Clock::time_point now = Clock::now();
      rule.deadline_ = now + std::chrono::duration_cast<Clock::duration>(share * (deadline_ - now));
    }
    if (node_pairs != kNever) rule.node_pairs = static_cast<std::uint64_t>(share * static_cast<double>(node_pairs));
    return rule;
  }

  /// The levels to walk to, one pass after another: within a budget first coarsely, so that there is an answer for all
  /// when it ends, then to the end. (Every level in turn costs three times what the last one does.)
  std::vector<std::uint64_t> passes() const
  {
    if (deepest != kNever) return {deepest};
    return {0, 2, kNever};
  }

private:
  bool may_stop_;
  Clock::time_point deadline_ = Clock::time_point::max();
};

/// Tells a walk whether its budget is spent, so that it has to end now. Reading a clock costs a fifth of a step. So the
/// clock is read seldom while much time is left, and more and more often towards the end.
class StopCheck {
public:
  /// @param tested counts the walk's sphere tests
  StopCheck(const StopRule& rule, const std::uint64_t& tested) : rule_(rule), tested_(tested) {}

  /// Before each step of the walk. Once over, always over.
  bool isOver()
  {
    if (over_ || !rule_.mayStop()) return over_;
    over_ = tested_ >= rule_.node_pairs || (rule_.isTimed() && asked_++ == next_look_ && look());
    return over_;
  }

private:
  using Clock = StopRule::Clock;

  /// Whether the time is over. If not, decides when to look again: after half of the steps for which the time left
  /// suffices, if each is as slow as the slowest of late.
  bool look()
  {
    constexpr std::uint64_t most = 64; // a step may be slow: a page of memory, a leaf of many near pairs
    const Clock::time_point now = Clock::now();
    const Clock::duration left = rule_.timeLeft(now);
    if (left <= Clock::duration::zero()) return true;
    if (asked_ > 1) {
      const Clock::duration mean = (now - looked_) / static_cast<Clock::rep>(wait_);
      step_ = std::max({mean, step_ / 2, Clock::duration(1)});
      wait_ = static_cast<std::uint64_t>(std::clamp<Clock::rep>(left / (2 * step_), 1, most));
    }
    looked_ = now;
    next_look_ += wait_;
    return false;
  }

  const StopRule& rule_;
  const std::uint64_t& tested_;
  std::uint64_t asked_ = 0, next_look_ = 0, wait_ = 1;
  Clock::time_point looked_;
  Clock::duration step_{0}; ///< how long one takes
  bool over_ = false;
};

} // namespace pcl_bsh
