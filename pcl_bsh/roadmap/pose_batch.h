// SPDX-License-Identifier: BSD-3-Clause
// Poses near each other, which one task answers.
#pragma once

#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/query/result.h>
#include <pcl_bsh/roadmap/pose_order.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_bsh {

/// Of one task.
struct PoseBatch {
  const Placed& a;
  const SphereHierarchy& b;
  const BodyBall& body;                 ///< of b
  std::vector<Eigen::Isometry3d> poses; ///< of b, neighbours near each other
  /// How far any point of b gets from where it is at each of the poses, where b moves about them; empty: b rests.
  std::vector<double> extents = {};
};

/// As many poses as one task answers: enough that what they have in common pays, few enough for many tasks.
inline constexpr std::size_t kBatchPoses = 256;

/// Likewise where poses have nothing in common but memory, and each takes long.
inline constexpr std::size_t kFlagPoses = 8;

} // namespace pcl_bsh
