// SPDX-License-Identifier: BSD-3-Clause
// Depths of triangles: bounds on pieces of them, which are cut where that helps the bounds most.
#pragma once

#include <pcl_bsh/depths/depths.h>

#include <cstdint>
#include <vector>

namespace pcl_bsh {

/// As depthsOf(), which has it for surfaces.
std::vector<Depth> depthsOfTriangles(const DeepSolid& solid, const QueriedRecords& queried,
                                     const Eigen::Isometry3d& T_world_queried,
                                     const std::vector<std::uint32_t>& records, unsigned threads, bool deepest,
                                     Work& work);

} // namespace pcl_bsh
