// SPDX-License-Identifier: BSD-3-Clause
// The ways to a faster answer that PCL itself offers, on the same clouds.
#pragma once

#include <pcl_bsh/tools/accuracy/study.h>

namespace pcl_bsh::accuracy {

/// FLANN's kd-tree exact and approximate, PCL's octree, and a kd-tree over clouds thinned by pcl::VoxelGrid, one thread
/// as PCL has them; warm, like ours. The column `once` has the time of thinning and of building a tree. Coordinates are
/// float, as PCL's are, about the middle of each cloud.
/// @throws std::invalid_argument a subject has faces
std::vector<Measurement> measurePeers(const Subject& subject, unsigned repetitions, const Progress& progress);

} // namespace pcl_bsh::accuracy
