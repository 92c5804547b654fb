// SPDX-License-Identifier: BSD-3-Clause
// A number along an axis (a height, a cant, a chainage, a widening), in straight or parabolic parts end to end.
#pragma once

#include <pcl_bsh/export.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// A place on such a line.
struct Knot {
  double at = 0.0;    ///< distance from the axis' beginning
  double value = 0.0; ///< there; two knots at one distance are a jump, where the second holds
};

/// Parts in the order of their beginnings. The first part holds before its beginning, too.
class Piecewise {
public:
  /// From `begin` on: value + slope t + bend t^2 / 2, where t is the distance from there.
  struct Part {
    double begin = 0.0; ///< distance along the axis
    double value = 0.0; ///< there
    double slope = 0.0; ///< there
    double bend = 0.0;  ///< change of the slope, per length

    /// The value at a distance.
    double operator()(double at) const { return value + (at - begin) * (slope + 0.5 * bend * (at - begin)); }
  };

  /// How a line goes on before its first knot and behind its last.
  enum class Ends : bool { held, extended };

  Piecewise() = default;
  /// Takes parts in the order of their beginnings.
  explicit Piecewise(std::vector<Part> parts) : parts_(std::move(parts)) {}

  /// Straight between knots. @pre their distances do not fall
  static Piecewise through(const std::vector<Knot>& knots, Ends ends);

  /// Whether it has no part.
  bool empty() const { return parts_.empty(); }
  /// In their order.
  const std::vector<Part>& parts() const { return parts_; }

  /// The value at a distance; 0 where there are no parts.
  double operator()(double at) const { return parts_.empty() ? 0.0 : partAt(at)(at); }

  /// The slope at a distance; 0 where there are no parts.
  double slope(double at) const
  {
    if (parts_.empty()) return 0.0;
    const Part& part = partAt(at);
    return part.slope + part.bend * (at - part.begin);
  }

private:
  const Part& partAt(double at) const
  {
    std::size_t low = 0, high = parts_.size(); // the answer is in [low, high)
    while (high - low > 1) {
      const std::size_t middle = (low + high) / 2;
      (parts_[middle].begin <= at ? low : high) = middle;
    }
    return parts_[low];
  }

  std::vector<Part> parts_;
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
