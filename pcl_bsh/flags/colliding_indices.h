// SPDX-License-Identifier: BSD-3-Clause
// Which points collide, as lists of their records: collisionFlags() without its array.
//
//   CollidingIndices hit;
//   for (const Eigen::Isometry3d& pose : poses) {
//     collidingIndices({hall}, {robot, pose}, request, hit); // the lists' memory is used again
//     ...                                                    // hit.a: what pcl::ExtractIndices takes
//   }
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/flags/collision_flags.h>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Records of the views, ascending: those that would collide, or be undecided, in FlagsResult. Empty where not asked
/// for.
struct CollidingIndices {
  std::vector<std::int32_t> a;           ///< points of a that collide
  std::vector<std::int32_t> b;           ///< points of b that collide
  std::vector<std::int32_t> undecided_a; ///< points of a that the request's accuracy lets the walk leave undecided
  std::vector<std::int32_t> undecided_b; ///< points of b that are left undecided for this reason
  Work work;                             ///< as collisionFlags() counts it
};

/// Which points collide with something of the other cloud? Throws as collisionFlags() does.
CollidingIndices collidingIndices(const Placed& a, const Placed& b, const FlagsRequest& request);

/// Writes into a result whose memory is used again.
void collidingIndices(const Placed& a, const Placed& b, const FlagsRequest& request, CollidingIndices& result);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
