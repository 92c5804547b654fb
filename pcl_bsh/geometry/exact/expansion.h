// SPDX-License-Identifier: BSD-3-Clause
// Exact sums of doubles, kept as unevaluated sums of doubles.
// (Shewchuk: Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates, 1997.)
// Needs round-to-nearest, and neither overflow nor underflow.
#pragma once

#include <pcl_bsh/geometry/rounding.h>

#include <array>
#include <cstddef>

namespace pcl_bsh {

/// An exact sum of up to Capacity doubles: non-overlapping terms, smallest first, none zero.
template <std::size_t Capacity>
class Expansion {
public:
  void add(double value) noexcept
  {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const WithError sum = twoSum(value, terms_[i]);
      if (sum.error != 0.0) terms_[kept++] = sum.error;
      value = sum.value;
    }
    if (value != 0.0) terms_[kept++] = value;
    size_ = kept;
  }

  void add(const WithError& terms) noexcept
  {
    add(terms.error);
    add(terms.value);
  }

  /// The largest term outweighs all others together.
  int sign() const noexcept { return size_ == 0 ? 0 : (terms_[size_ - 1] > 0.0 ? 1 : -1); }

private:
  std::array<double, Capacity> terms_;
  std::size_t size_ = 0;
};

} // namespace pcl_bsh
