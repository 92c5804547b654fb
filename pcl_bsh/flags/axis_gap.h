// SPDX-License-Identifier: BSD-3-Clause
// Leaves of triangles that are apart along an axis, by their coordinates as given: where flat parts face each other at
// about the clearance, floats decide no pair of them, and this all pairs of two leaves at once.
#pragma once

#include <pcl_bsh/flags/query.h>
#include <pcl_bsh/geometry/exact/long_number.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/query/work.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace pcl_bsh {

/// Of one leaf of a, against one leaf of b after the other. Both are of triangles.
/// @tparam Leaf has `count`, `begin` and `record(i)`
template <class Leaf>
class AxisGap {
public:
  AxisGap(const FlagQuery& query, const Leaf& leaf) : query_(query), leaf_(leaf) {}

  /// Whether the leaves are surely farther apart than the reach of all pairs, along the axis that a triangle of b lies
  /// across; false where it lies otherwise, or a cloud is turned. Asked once for a leaf.
  /// @param normal of the triangle, of length 1 @param other leaf of b @param work counts the comparison
  bool isBeyond(const float* normal, const Leaf& other, Work& work)
  {
    if (other.begin == asked_ && other.voxel == asked_in_) return is_beyond_;
    std::size_t axis = 0;
    while (axis < 3 && !(std::abs(normal[axis]) > 1.0f - 0x1p-20f)) ++axis;
    if (axis == 3 || isTurned(query_.a) || isTurned(query_.b)) return false;
    asked_ = other.begin, asked_in_ = other.voxel;
    if (axis != axis_) own_ = rangeOf(query_.a, leaf_, axis);
    axis_ = axis;
    const Range of_other = rangeOf(query_.b, other, axis);
    ++work.exact_decisions;
    is_beyond_ = isBeyond(own_.high, of_other.low, axis, 1.0) || isBeyond(own_.low, of_other.high, axis, -1.0);
    return is_beyond_;
  }

private:
  static bool isTurned(const Placed& cloud) { return cloud.pose.linear() != Eigen::Matrix3d::Identity(); }

  struct Range {
    double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  };

  static Range rangeOf(const Placed& cloud, const Leaf& leaf, std::size_t axis)
  {
    Range range;
    for (std::uint32_t i = 0; i < leaf.count; ++i)
      for (const Point3& corner : cloud.hierarchy().view().triangles->triangle(leaf.record(i))) {
        range.low = std::min(range.low, corner[axis]);
        range.high = std::max(range.high, corner[axis]);
      }
    return range;
  }

  /// Whether b's place is above a's by more than the reach, both turned over where `up` is -1.
  bool isBeyond(double a, double b, std::size_t axis, double up) const
  {
    const auto k = static_cast<Eigen::Index>(axis);
    const LongNumber above = (LongNumber(b) - LongNumber(a)) +
                             (LongNumber(query_.b.pose.translation()[k]) - LongNumber(query_.a.pose.translation()[k]));
    bool sure = true;
    return ((up < 0.0 ? -above : above) - LongNumber(query_.pairs.reach.length())).sign(sure) > 0;
  }

  const FlagQuery& query_;
  const Leaf& leaf_;
  std::size_t axis_ = 3; ///< that own_ is along
  Range own_;
  std::uint32_t asked_ = 0; ///< the leaf of b asked about last, and what was found
  const void* asked_in_ = nullptr;
  bool is_beyond_ = false;
};

} // namespace pcl_bsh
