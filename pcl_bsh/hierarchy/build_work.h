// SPDX-License-Identifier: BSD-3-Clause
// Cost of building a part of a hierarchy, in counts.
#pragma once

#include <cstdint>

namespace pcl_bsh {

/// Parts that a query built, in all clouds. Equal for any number of threads: each voxel is built once.
struct BuildWork {
  std::uint64_t voxels_built = 0; ///< voxels whose octree and spheres were built, on their first visit
  /// Bounding volumes fitted to points: the spheres of these voxels, and the slabs and boxes that some queries fit
  /// beside spheres, once, when they first ask for them.
  std::uint64_t volumes_built = 0;
};

} // namespace pcl_bsh
