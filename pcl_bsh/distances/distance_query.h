// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/distances/reached_distance.h>
#include <pcl_bsh/query/stop_rule.h>
#include <pcl_bsh/traversal/point_pairs.h>

#include <hwy/cache_control.h>

#include <cstdint>

namespace pcl_bsh {

/// The input that the walks through all voxels of a share. The pairs' reach is the request's max_distance.
struct DistancesQuery {
  const Placed& a;
  const Placed& b;
  const PointPairs& pairs;
  RelativeRotation rotation;
  double unit;            ///< of lengths as floats, in the clouds' unit
  double tolerance = 0.0; ///< how much farther than the nearest a point may be
  /// The greatest distance so far, where only the greatest is asked for: nearer points need not be measured. Null: all
  /// points are. @pre if not null: no max_distance, and the accuracy is exact; else bounds are not those of the nearest
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

/// The outcome of one walk through a voxel of a.
struct MeasuredVoxel {
  Work work;
  bool undecided = false; ///< whether the walk left points undecided
};

} // namespace pcl_bsh
