// SPDX-License-Identifier: BSD-3-Clause
// Closest approach of a point that moves along a segment to a point at rest.
#pragma once

#include <pcl_bsh/geometry/triangle/separation.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {

/// Instants are in [0, 1]: 0 at the segment's start, 1 at its end. All in double. With u = 2^-53, the distance, and the
/// distances at the two instants, are right within 16 u of the largest of |away|, |motion| and near_enough, however
/// long the segment is. The chord that is near enough is measured from the foot of the perpendicular. The roots of the
/// quadratic equation are not used: their discriminant is a difference of terms of the size (|away| |motion|)^2, and on
/// a segment of 100 km it loses millimetres.
/// @param away from the point at rest to where the segment starts. Lengths whose squares underflow count as 0.
inline Approach closestApproach(const Point3& away, const Point3& motion, double near_enough)
{
  double length = 0.0, along = 0.0, apart = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    length += motion[axis] * motion[axis];
    along += motion[axis] * away[axis];
    apart += away[axis] * away[axis];
  }
  const auto squaredAt = [&](double time) {
    double squared = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double place = away[axis] + time * motion[axis];
      squared += place * place;
    }
    return squared;
  };
  Approach approach;
  const double foot = length > 0.0 ? -along / length : 0.0;
  approach.at = std::clamp(foot, 0.0, 1.0);
  const double squared = squaredAt(approach.at), limit = near_enough * near_enough;
  if (!(squared <= limit)) return approach;
  approach.contact = true;
  approach.distance = std::sqrt(squared);
  if (apart <= limit || !(length > 0.0)) return approach;
  const double half_chord = std::sqrt(std::max(0.0, limit - squaredAt(foot)) / length);
  approach.enter = std::clamp(foot - half_chord, 0.0, approach.at);
  return approach;
}

} // namespace pcl_bsh
