// SPDX-License-Identifier: BSD-3-Clause
// A record of the scan as the model sees it during an interval of a path, in double: a point, or a triangle's corners.
#pragma once

#include <pcl_bsh/hierarchy/record_corners.h>
#include <pcl_bsh/trajectory/query.h>

namespace pcl_bsh {

struct RecordCourse {
  Corners world = {};
  MovingCorners arcs =
      {}; ///< through its places at the first, the middle and the last pose; straight where motion is swept

  RecordCourse() = default;
  RecordCourse(const TrajectoryQuery& query, std::uint32_t record, const PathInterval& interval);

  Corners seenAt(const PathPose& pose) const;

  /// Swept: returns the approach of the record to one of the model, within a 64th of the tolerance.
  /// @param nearest whether the smallest distance counts, or the first instant alone @param early_enough as
  ///   approachOf() has it
  Approach approachTo(const TrajectoryQuery& query, std::uint32_t record, const PathInterval& interval,
                      double near_enough, bool nearest, double early_enough = 1.0) const;
};

/// A record of the model, which is at rest.
MovingCorners restingAt(const TrajectoryQuery& query, std::uint32_t record);
MovingCorners restingAt(const Point3& place);

} // namespace pcl_bsh
