// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/flags/flag_writer.h>
#include <pcl_bsh/query/length_band.h>
#include <pcl_bsh/query/stop_rule.h>
#include <pcl_bsh/traversal/point_pairs.h>

#include <cstdint>
#include <vector>

namespace pcl_bsh {

/// The input that the walks through all voxels of a share.
struct FlagQuery {
  const Placed& a;
  const Placed& b;
  const PointPairs& pairs;
  RelativeRotation rotation;
  LengthBand length_band;
  /// Set where points are uncertain: `pairs` decides which pairs may collide, `certain` which ones do for certain.
  const PointPairs* certain = nullptr;
  LengthBand surely; ///< the band of surePairs()

  const PointPairs& surePairs() const { return certain ? *certain : pairs; }
};

/// The outcome of one walk through a voxel of a.
struct FlaggedVoxel {
  Work work;
  bool undecided = false; ///< whether the walk left points undecided
};

/// Appends the voxels of a that may come near to anything of b, in their order.
void findNearVoxels(const FlagQuery& query, std::vector<std::uint32_t>& near, Work& work);

/// Flags the points of one voxel of a.
FlaggedVoxel flagVoxel(const FlagQuery& query, const StopRule& rule, std::uint32_t voxel, FlagWriter& writer);

} // namespace pcl_bsh
