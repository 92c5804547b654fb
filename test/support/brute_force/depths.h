// SPDX-License-Identifier: BSD-3-Clause
// The oracle of depths: every place against every triangle.
#pragma once

#include <pcl_bsh/depths/depths.h>

namespace pcl_bsh::brute_force {

/// For points and balls, its contract is that of its namesake in depths.h. Triangles are looked at in the places of a
/// grid: no deeper than between these is what lies among them.
/// @param steps of the grid, along each side of a triangle
DepthsResult depthsIn(const DeepSolid& solid, const QueriedRecords& queried, const Eigen::Isometry3d& T_world_queried,
                      unsigned steps = 64);

} // namespace pcl_bsh::brute_force
