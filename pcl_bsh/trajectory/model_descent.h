// SPDX-License-Identifier: BSD-3-Clause
// One point of the scan at one pose against the model's spheres, in double: where many points of the model lie closer
// together than floats of the path tell places apart, boxes and leaves in floats would leave every pair to be compared.
#pragma once

#include <pcl_bsh/trajectory/voxel_results.h>

#include <cstdint>
#include <limits>

namespace pcl_bsh {

/// What is asked about a point.
struct PointAtPose {
  std::uint32_t record; ///< of the scan
  std::uint32_t pose;
  NearestPoint* best; ///< its nearest point, to be kept; null: that is not asked for
  bool for_pose;      ///< whether its nearest point counts for the pose
};

/// What is known of it then.
struct PointMet {
  bool collides = false;
  double gap = std::numeric_limits<double>::infinity(); ///< where a nearest point is asked for: its distance, rounded
};

/// Compares a point with the points of one of the model's voxels; where no nearest one is asked for, up to the first
/// that collides.
PointMet meetVoxel(const TrajectoryQuery& query, VoxelResults& results, const PointAtPose& point, std::uint32_t voxel);

/// The same with those below a child of a node above the voxels.
PointMet meetBelow(const TrajectoryQuery& query, VoxelResults& results, const PointAtPose& point, std::uint32_t node,
                   std::uint32_t child);

} // namespace pcl_bsh
