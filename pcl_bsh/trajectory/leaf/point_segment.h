// SPDX-License-Identifier: BSD-3-Clause
// A point of the scan as the model sees it during a swept motion, in double.
#pragma once

#include <pcl_bsh/trajectory/leaf/closest_approach.h>
#include <pcl_bsh/trajectory/query.h>

namespace pcl_bsh {

/// Where a point of the scan is seen at the ends of an interval; between them it moves in a straight line.
struct PointSegment {
  std::uint32_t first, last; ///< poses of the path
  Point3 start, end;

  PointSegment(const TrajectoryQuery& query, std::uint32_t record, const PathInterval& interval)
  : first(interval.first),
    last(interval.last)
  {
    const Point3 world = carried(query.scan.pose, query.scan.hierarchy().view().point(record));
    start = query.path.poses[first].see(world);
    end = query.path.poses[last].see(world);
  }

  /// Returns the closest approach of the point to a point of the model.
  Approach approachTo(const TrajectoryQuery& query, std::uint32_t record, double near_enough) const
  {
    Point3 at = query.model.view().point(record);
    for (std::size_t axis = 0; axis < 3; ++axis) at[axis] -= query.boxes.origin[axis];
    const Point3 from = query.path.stretched(first, at), to = query.path.stretched(last, at);
    Point3 away, motion;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      away[axis] = start[axis] - from[axis];
      motion[axis] = (end[axis] - start[axis]) - (to[axis] - from[axis]);
    }
    return closestApproach(away, motion, near_enough);
  }
};

} // namespace pcl_bsh
