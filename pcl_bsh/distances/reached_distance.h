// SPDX-License-Identifier: BSD-3-Clause
// The greatest distance that was measured so far. Searches for the greatest of all leave out points that are certainly
// nearer, as Taha and Hanbury do ("An efficient algorithm for calculating the exact Hausdorff distance", IEEE TPAMI
// 37(11), 2015), and whole nodes.
#pragma once

#include <atomic>
#include <cmath>
#include <limits>

namespace pcl_bsh {

class ReachedDistance {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

public:
  /// @param distance of a point, rounded to the nearest double. From any thread
  void raise(double distance) noexcept
  {
    // A distance that rounds to this double is above the one before: what is below that is smaller without a doubt.
    const double certain = std::nextafter(distance, -kInfinity);
    double now = below_.load(std::memory_order_relaxed);
    while (certain > now && !below_.compare_exchange_weak(now, certain, std::memory_order_relaxed)) {
    }
  }

  /// Whether no distance up to the bound is the greatest, or as great. False of NaN.
  /// @param upper bound, in multiples of `unit` @param unit in the clouds' unit; the product is rounded
  bool exceeds(float upper, double unit) const noexcept
  {
    return std::nextafter(double{upper} * unit, kInfinity) < below_.load(std::memory_order_relaxed);
  }

private:
  std::atomic<double> below_{-kInfinity};
};

} // namespace pcl_bsh
