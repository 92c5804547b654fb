// SPDX-License-Identifier: BSD-3-Clause
// The ray along the last axis from a place that is known within an error, against boxes of floats.
#pragma once

#include <pcl_bsh/geometry/point3.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

namespace pcl_bsh {

/// A box, both corners included.
struct FloatBox {
  float low[3], high[3];
};

/// A column holds some tens of boxes, of which the ray meets one or two. Comparing one number at a time takes branches
/// that cannot be foretold. So all numbers of a box are compared at once, by the compiler's vectors.
class UpwardRay {
public:
  /// @param at finite @param error per axis
  UpwardRay(const Point3& at, double error)
  {
    float low[3], high[3]; // the place is between these: rounding takes no number past a box's float
    for (std::size_t k = 0; k < 3; ++k)
      low[k] = static_cast<float>(at[k] - error), high[k] = static_cast<float>(at[k] + error);
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    most_ = Floats{high[0], high[1], kInfinity, kInfinity};
    least_ = Floats{-kInfinity, low[0], low[1], low[2]};
    highest_ = high[2];
  }

  /// Whether it surely meets nothing of a box: one is beside the other, or the box is below.
  bool misses(const FloatBox& box) const noexcept
  {
    const char* const numbers = reinterpret_cast<const char*>(&box);
    Floats low, high; // x y z, and the other corner's x; z, and the other corner's x y z
    std::memcpy(&low, numbers, sizeof low);
    std::memcpy(&high, numbers + 2 * sizeof(float), sizeof high);
    const auto beyond = reinterpret_cast<Words>((low > most_) | (high < least_));
    return (beyond[0] | beyond[1]) != 0;
  }

  /// Whether it surely begins below all of a box.
  bool beginsBelow(const FloatBox& box) const noexcept { return highest_ < box.low[2]; }

private:
  using Floats = float __attribute__((vector_size(16)));
  using Words = std::int64_t __attribute__((vector_size(16)));

  Floats most_, least_; ///< bounds of the low and of the high corner of a box that the ray may meet
  float highest_;       ///< of where it begins
};

} // namespace pcl_bsh
