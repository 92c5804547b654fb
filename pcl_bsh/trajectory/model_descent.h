// SPDX-License-Identifier: BSD-3-Clause
// Compares one point of the scan at one pose with the model's spheres, in double. It is for places where many points of
// the model lie closer together than floats of the path tell apart. There, boxes and leaves in floats would leave every
// pair to be compared.
#pragma once

#include <pcl_bsh/trajectory/voxel_results.h>

#include <cstdint>
#include <limits>

namespace pcl_bsh {

/// A point at a pose, and the answers that are wanted about it.
struct PointAtPose {
  std::uint32_t record; ///< of the scan
  std::uint32_t pose;
  NearestPoint* best; ///< gets its nearest point; null: not wanted
  bool for_pose;      ///< whether its nearest point counts for the pose
};

/// The answer about a point at a pose.
struct PointMet {
  bool collides = false;
  double gap = std::numeric_limits<double>::infinity(); ///< where a nearest point is asked for: its distance, rounded
};

/// Compares a point with the points of one of the model's voxels. If `voxel` is kAboveVoxels, compares it with all
/// points below a child of a node above the voxels. Ends at the first point that collides, unless a nearest point is
/// asked for.
PointMet meet(const TrajectoryQuery& query, VoxelResults& results, const PointAtPose& point, std::uint32_t voxel,
              std::uint32_t node, std::uint32_t child);

} // namespace pcl_bsh
