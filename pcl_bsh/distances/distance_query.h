// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/distances/reached_distance.h>
#include <pcl_bsh/query/stop_rule.h>
#include <pcl_bsh/traversal/point_pairs.h>

#include <hwy/cache_control.h>

#include <cstdint>

namespace pcl_bsh {

/// What the walks through all voxels of a have in common. The pairs' reach is the request's max_distance.
struct DistancesQuery {
  const Placed& a;
  const Placed& b;
  const PointPairs& pairs;
  RelativeRotation rotation;
  double unit;            ///< of lengths as floats, in the clouds' unit
  double tolerance = 0.0; ///< how much farther than the nearest a point may be
  /// Where only the greatest distance is asked for: what is nearer than this one need not be measured. Null: all are.
  /// @pre not null: no max_distance, the accuracy exact; else bounds are not those of the nearest
  ReachedDistance* reached = nullptr;

  /// Whether a greater distance than the bound has been measured, where only the greatest is asked for.
  bool exceeds(float upper) const { return reached && reached->exceeds(upper, unit); }
};

/// Where the answers of one walk go: arrays with an entry for each record of a. No interval: null.
struct DistanceSheet {
  double* distance;
  std::uint32_t* nearest;
  Interval* interval;

  void set(std::uint32_t record, double to_nearest, std::uint32_t other, const Interval& certain) const
  {
    distance[record] = to_nearest;
    nearest[record] = other;
    if (interval) interval[record] = certain;
  }

  /// Before set().
  void prefetch(std::uint32_t record) const
  {
    hwy::Prefetch(distance + record);
    hwy::Prefetch(nearest + record);
  }
};

/// What one walk through a voxel came to.
struct MeasuredVoxel {
  Work work;
  bool undecided = false; ///< whether points were left so
};

} // namespace pcl_bsh
