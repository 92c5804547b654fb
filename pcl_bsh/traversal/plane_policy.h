// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace pcl_bsh {

/// Decides when planes are asked: once enough pairs were decided in vain to pay for them. Answers that tell nothing put
/// the next question off.
class PlanePolicy {
public:
  /// @param decisions in vain before planes are asked
  explicit PlanePolicy(std::uint64_t decisions) : next_(decisions) {}

  void decidedInVain() { ++decisions_; }
  void forget() { decisions_ = 0; }
  std::uint64_t decisionsInVain() const { return decisions_; }

  bool mayAsk() const { return decisions_ >= next_; }
  bool begins() const { return decisions_ == next_; } ///< whether the last decision was the first to pay for planes

  /// Planes are not asked until so many pairs were decided in vain.
  void wait(std::uint64_t decisions)
  {
    next_ = decisions;
    asked_in_vain_ = 0;
  }

  /// Takes note of an answer. After 32 answers in a row that tell nothing, planes are not asked until decisions are
  /// twice as many.
  /// @param known whether the answer told anything @return known
  bool answered(bool known)
  {
    constexpr std::uint32_t most = 32;
    asked_in_vain_ = known ? 0 : asked_in_vain_ + 1;
    if (asked_in_vain_ == most) wait(2 * decisions_);
    return known;
  }

private:
  std::uint64_t decisions_ = 0, next_;
  std::uint32_t asked_in_vain_ = 0;
};

} // namespace pcl_bsh
