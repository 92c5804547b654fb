// SPDX-License-Identifier: BSD-3-Clause
// What a query cost, counted.
#pragma once

#include <cstdint>

namespace pcl_bsh {

/// Noise-free cost of a query. The same for any number of threads.
struct Work {
  std::uint64_t node_pairs = 0;      ///< sphere-sphere tests of two nodes
  std::uint64_t leaf_pairs = 0;      ///< pairs of leaves whose points were compared
  std::uint64_t exact_decisions = 0; ///< pairs of points, or of tiny nodes, that float arithmetic could not decide
  std::uint64_t voxels_built = 0;    ///< voxels whose octree and spheres this query built, of both clouds

  Work& operator+=(const Work& other) noexcept
  {
    node_pairs += other.node_pairs;
    leaf_pairs += other.leaf_pairs;
    exact_decisions += other.exact_decisions;
    voxels_built += other.voxels_built;
    return *this;
  }
};

} // namespace pcl_bsh
