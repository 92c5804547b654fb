// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

namespace pcl_bsh {

/// Which points of a leaf were compared with which records of the model during a motion, as far as is remembered: parts
/// of one triangle hold nothing new.
class ComparedPairs {
public:
  void clear()
  {
    if (is_used_) *this = ComparedPairs();
  }

  /// @param points bits of them. @return those that were not compared with the record; from now on they are
  std::uint32_t add(std::uint32_t record, std::uint32_t points)
  {
    is_used_ = true;
    Entry& entry = entries_[record % entries_.size()];
    if (entry.record != record || entry.points == 0) entry = {record, 0};
    const std::uint32_t left = points & ~entry.points;
    entry.points |= points;
    return left;
  }

private:
  struct Entry {
    std::uint32_t record = 0, points = 0;
  };

  std::array<Entry, 64> entries_ = {};
  bool is_used_ = false;
};

} // namespace pcl_bsh
