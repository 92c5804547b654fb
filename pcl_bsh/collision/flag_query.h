// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/query/acceptance.h>
#include <pcl_bsh/query/stop_rule.h>
#include <pcl_bsh/traversal/point_pairs.h>

#include <cstdint>
#include <vector>

namespace pcl_bsh {

/// What the walks through all voxels of a have in common.
struct FlagQuery {
  const Placed& a;
  const Placed& b;
  const PointPairs& pairs;
  RelativeRotation rotation;
  Acceptance acceptance;
};

/// A voxel of a with points to flag.
struct FlaggedPlace {
  std::uint32_t slot; ///< its number among the voxels of the query
  std::uint32_t voxel;
};

/// What one walk through a voxel came to.
struct FlaggedVoxel {
  Work work;
  bool undecided = false; ///< whether points were left so
};

/// Appends the voxels of a that may come near to anything of b, in their order.
void findNearVoxels(const FlagQuery& query, std::vector<FlaggedPlace>& near, Work& work);

} // namespace pcl_bsh
