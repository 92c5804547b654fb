// SPDX-License-Identifier: BSD-3-Clause
// How a query went: which spheres it tested, which of them it opened, which were out of reach. For pictures and for
// understanding; anyCollision() itself records nothing.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/pairs/any_collision.h>

#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The fate of a sphere during a walk; of several fates, the last one in this list.
enum class SphereFate : std::uint8_t {
  pruned,   ///< tested; it, or all children of the sphere it was tested against, were out of reach
  kept,     ///< within reach as far as it was tested, but not opened before the walk was done
  opened,   ///< its children, or its voxel's, were tested
  compared, ///< a leaf whose points were compared
};

/// A sphere that a query tested, and what became of it.
struct TracedSphere {
  Point3 center = {0, 0, 0}; ///< in its own cloud's frame
  double radius = 0.0;       ///< in the cloud's unit
  int level = 0; ///< as Accuracy::level() counts: 0 a voxel, 1 the children of its root; -1 above the voxels
  SphereFate fate = SphereFate::pruned;
};

/// Result of traceCollision(), and the way that it took.
struct CollisionTrace {
  std::vector<TracedSphere> a, b; ///< each sphere that was tested, once; in the order of the trees
  AnyResult result;               ///< what anyCollision() returns
};

/// Answers as anyCollision() does, with the work of one thread, and tells how. Where points have uncertainties, both
/// searches are told together: the one for what may collide and the one for what does for certain. The request's
/// accuracy must be exact or a tolerance: those that search depth first.
/// @throws std::invalid_argument as anyCollision() does, and for an accuracy that stops early
CollisionTrace traceCollision(const Placed& a, const Placed& b, const AnyRequest& request);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
