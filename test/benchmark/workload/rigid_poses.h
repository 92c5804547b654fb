// SPDX-License-Identifier: BSD-3-Clause
// Poses of one body against another, in three classes that cost a collision query very differently.
#pragma once

#include "reference_distance.h"

namespace pcl_bsh::bench {

enum class PoseClass { hit, near_miss, far };

struct PosedCase {
  RigidPose pose;  ///< of b in a's frame
  PoseClass kind;  ///< hit: within one spacing; near miss: 1.3 to 4 spacings apart; far: at least 20
  double distance; ///< true smallest distance, in double
};

/// `count` random orientations and approach directions, the three classes in turn. The body b comes from afar along
/// its direction until its distance is the one wanted, found by steps that cannot overshoot and then bisection.
std::vector<PosedCase> rigidPoses(const ReferenceTree& a, const ReferenceTree& b, double spacing, std::size_t count,
                                  std::uint64_t seed);

} // namespace pcl_bsh::bench
