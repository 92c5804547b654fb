// SPDX-License-Identifier: BSD-3-Clause
// What building a part of a hierarchy costs, in counts.
#pragma once

#include <pcl_bsh/hierarchy/node.h>

#include <cstdint>
#include <vector>

namespace pcl_bsh {

/// What a query built on its way, of all clouds. The same for any number of threads: each voxel is built once.
struct BuildWork {
  std::uint64_t voxels_built = 0; ///< voxels whose octree and spheres were built, on their first visit
  std::uint64_t volumes_built =
      0; ///< bounding volumes fitted to points: the spheres of these voxels, and the slabs and
         ///< boxes that some queries fit beside spheres, once, when they first ask for them
};

/// Children of all these nodes: so many spheres they hold.
inline std::uint64_t countChildren(const std::vector<Node>& nodes) noexcept
{
  std::uint64_t count = 0;
  for (const Node& node : nodes) count += node.count;
  return count;
}

} // namespace pcl_bsh
