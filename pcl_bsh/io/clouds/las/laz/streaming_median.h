// SPDX-License-Identifier: BSD-3-Clause
// A median of the last values, nearly: five values in order, of which a new one drives out the least or the greatest.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace pcl_bsh::io::laz {

class StreamingMedian {
public:
  std::int32_t value() const { return sorted_[2]; }

  void add(std::int32_t value)
  {
    // The greatest goes until a value is not below the median, then the least until one is not above it.
    const bool below = value<sorted_[2], above = value> sorted_[2];
    if (drops_greatest_) {
      insert(value, 4, -1);
      if (!below) drops_greatest_ = false;
    }
    else {
      insert(value, 0, 1);
      if (!above) drops_greatest_ = true;
    }
  }

private:
  /// Drops the value at `hole` and inserts the new one in order. Values between the two places move by one towards
  /// `hole`, which is against `step`.
  void insert(std::int32_t value, int hole, int step)
  {
    const auto at = [&](int i) -> std::int32_t& { return sorted_[static_cast<std::size_t>(i)]; };
    for (int moved = 0; moved < 4; ++moved, hole += step) {
      const std::int32_t next = at(hole + step);
      if (step < 0 ? value >= next : value <= next) break;
      at(hole) = next;
    }
    at(hole) = value;
  }

  std::array<std::int32_t, 5> sorted_{};
  bool drops_greatest_ = true;
};

} // namespace pcl_bsh::io::laz
