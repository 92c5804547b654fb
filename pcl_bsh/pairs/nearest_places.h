// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/geometry/triangle/separation.h>
#include <pcl_bsh/hierarchy/record_corners.h>
#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/query/result.h>

#include <Eigen/Geometry>

#include <array>

namespace pcl_bsh {

/// Where two records are nearest to each other, a's and b's, in the world, within rounding; of balls, their centres.
inline std::array<Eigen::Vector3d, 2> nearestPlaces(const Placed& a, const Placed& b, PointPair pair)
{
  const auto vectorOf = [](const Point3& p) { return Eigen::Vector3d(p[0], p[1], p[2]); };
  const PointsView &view_a = a.hierarchy().view(), &view_b = b.hierarchy().view();
  const Corners own_a = cornersOf(view_a, pair.a), own_b = cornersOf(view_b, pair.b);
  const Eigen::Vector3d first = b.pose * vectorOf(own_b.at[0]);
  if (!view_a.triangles && !view_b.triangles) return {a.pose * vectorOf(own_a.at[0]), first};
  const auto seen = [&](Corners corners, const Eigen::Isometry3d& pose) { // from one corner, so that little is rounded
    for (Point3& p : corners.at) {
      const Eigen::Vector3d at = pose * vectorOf(p) - first;
      p = {at.x(), at.y(), at.z()};
    }
    return corners;
  };
  const Separation apart = separationOf(seen(own_a, a.pose), seen(own_b, b.pose));
  return {first + vectorOf(apart.place_a), first + vectorOf(apart.place_b)};
}

} // namespace pcl_bsh
