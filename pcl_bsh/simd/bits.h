// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstdint>
#include <iterator>

namespace pcl_bsh {

/// The numbers of the bits that are set, the lowest first: for (const std::uint32_t lane : Bits(near)). Bits that the
/// body sets or clears in `near` change nothing.
class Bits {
public:
  explicit Bits(std::uint32_t set) : left_(set) {}

  Bits begin() const { return *this; }
  static std::default_sentinel_t end() { return {}; }

  bool operator==(std::default_sentinel_t) const { return left_ == 0; }
  std::uint32_t operator*() const { return static_cast<std::uint32_t>(std::countr_zero(left_)); }
  void operator++() { left_ &= left_ - 1; }

private:
  std::uint32_t left_;
};

} // namespace pcl_bsh
