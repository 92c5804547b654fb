// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/query/stop_rule.h>
#include <pcl_bsh/trajectory/query.h>

#include <cstdint>
#include <vector>

namespace pcl_bsh {

/// Takes one voxel of the scan along those intervals of the path during which it may be near the model, in their order.
/// Writes what it finds of the voxel's points to the query's result. Different voxels may be walked at the same time.
VoxelResult walkVoxel(const TrajectoryQuery& query, const StopRule& rule, std::uint32_t voxel,
                      const std::vector<std::uint32_t>& intervals, Progress& progress);

} // namespace pcl_bsh
