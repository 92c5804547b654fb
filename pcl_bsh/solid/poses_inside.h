// SPDX-License-Identifier: BSD-3-Clause
// A solid that stands at one pose after another: which points of a cloud does it hold, and when first?
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/query/pose_list.h>
#include <pcl_bsh/query/result.h>
#include <pcl_bsh/solid/solid.h>

#include <cstdint>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {
/// The result of findPosesInside().
struct PosesInside {
  /// One per record of the cloud's view: the first pose at which the point is inside, or on the surface; or kNothing.
  std::vector<std::uint32_t> first;
  std::size_t inside = 0; ///< records that have one
  Work work;              ///< as LabelsResult counts it, at all poses
};

/// Finds the first pose of the solid that holds each point. A node of the cloud is visited only for the poses at which
/// it may meet the surface, and for none after the first that holds all of it. No voxel is built.
/// @param T_world_solid fewer than 2^32 - 1. @param threads 0: all of the machine's
/// @throws std::invalid_argument when a pose is not rigid
PosesInside findPosesInside(const Placed& cloud, const Solid& solid, const PoseList& T_world_solid,
                            unsigned threads = 1);

/// Fills a result, whose memory is used again; it is empty after an exception.
void findPosesInside(const Placed& cloud, const Solid& solid, const PoseList& T_world_solid, PosesInside& result,
                     unsigned threads = 1);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
