// SPDX-License-Identifier: BSD-3-Clause
// Counted cost of a query.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/build_work.h>

#include <cstdint>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Noise-free cost of a query: tests and updates of bounding volumes, as in the paper, and what was done to points.
/// Equal for any number of threads and any instruction set, unless a query's declaration says otherwise.
struct Work : BuildWork {
  /// Tests of the bounding volumes of two nodes, or of a node against what is asked for: a ball, a box, a way. One
  /// test, whichever volumes it compares (sphere and slab of the same two nodes: one).
  std::uint64_t node_pairs = 0;
  /// Bounding volumes that were carried into the frame where they were tested, each time. Two clouds: a sphere's
  /// centre, from one frame to the other. A path: a sphere's way during an interval of poses. Neighbour searches: the
  /// query's ball, into the frame of a voxel.
  std::uint64_t volumes_carried = 0;
  std::uint64_t leaf_pairs = 0;      ///< pairs of leaves whose points were compared
  std::uint64_t exact_decisions = 0; ///< pairs of points, or of tiny nodes, that float arithmetic could not decide
  std::uint64_t ranked = 0; ///< of searches for the nearest: candidates counted to bound the k-th distance, each time

  /// All updates of bounding volumes, as the paper counts them.
  std::uint64_t updates() const noexcept { return volumes_carried + volumes_built; }

  /// The sum of two queries.
  Work& operator+=(const Work& other) noexcept
  {
    voxels_built += other.voxels_built;
    volumes_built += other.volumes_built;
    node_pairs += other.node_pairs;
    volumes_carried += other.volumes_carried;
    leaf_pairs += other.leaf_pairs;
    exact_decisions += other.exact_decisions;
    ranked += other.ranked;
    return *this;
  }
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
