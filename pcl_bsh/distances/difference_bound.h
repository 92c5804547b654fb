// SPDX-License-Identifier: BSD-3-Clause
// When a point of b is farther than another one for all points within a sphere of a, though the sphere is wider than
// the difference. Spheres of b that are far away and near each other differ by less than a sphere of a is wide, so that
// bounds of their distances overlap. But where points of a move, all these distances change by nearly the same.
//
// p lies within `radius` of c, and q and q* are `extent` apart at most, and at least `nearest` from p. Where p moves,
// the difference |p - q| - |p - q*| changes by at most the difference of two unit vectors, which is extent / nearest at
// most. If |c - q| exceeds |c - q*| by more than radius * extent / nearest, q* is nearer to all p. For bounds of the
// whole sphere, lower <= |c - q| - radius and upper >= |c - q*| + radius. The condition then is
//   lower > upper - radius * (2 - extent / nearest).
// Balls of b shift their distances by their radii, which cancel out.
#pragma once

#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/hierarchy/node.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {

/// How far points below the children of a node are from each other at most, in the node's unit.
inline double extentBelow(const Node& node)
{
  double extent = 0.0;
  for (std::uint32_t i = 0; i < node.count; ++i)
    for (std::uint32_t k = 0; k <= i; ++k) {
      const double x = double{node.x[i]} - node.x[k], y = double{node.y[i]} - node.y[k],
                   z = double{node.z[i]} - node.z[k];
      extent = std::max(extent, std::sqrt(x * x + y * y + z * z) + node.r[i] + node.r[k]);
    }
  return extent * (1.0 + kDoubleMargin);
}

class DifferenceBound {
public:
  DifferenceBound() = default; ///< nothing is outdone

  /// @param extent upper bound of the distance between two points of b
  /// @param nearest lower bound of the distance between a point of a and one of b
  DifferenceBound(double extent, double nearest)
  {
    if (!(extent < kFarExtents * nearest)) return; // near, or not a number
    turn_ = extent / nearest * (1.0 + kDoubleMargin);
    is_possible_ = true;
  }

  bool isPossible() const { return is_possible_; }

  /// By how much bounds may overlap and yet one of two spheres be outdone: radius * (2 - extent / nearest), or less.
  /// @param radius of the sphere of a, or less: in the unit of the bounds
  float turnOf(double radius) const
  {
    return is_possible_ ? roundDown(radius * (2.0 - turn_) * (1.0 - kDoubleMargin)) : 0.0f;
  }

private:
  static constexpr double kFarExtents = 1.0; ///< nearer, little is outdone

  double turn_ = 2.0; ///< of unit vectors to points of b, at most
  bool is_possible_ = false;
};

} // namespace pcl_bsh
