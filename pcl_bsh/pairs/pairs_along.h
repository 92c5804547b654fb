// SPDX-License-Identifier: BSD-3-Clause
// Pairs of points that come near each other while one cloud moves a little.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/pairs/contacts.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <limits>

namespace pcl_bsh {

/// The ways of a cloud's places. One that is at p in the cloud's frame goes straight from middle p - half(p) to middle
/// p + half(p), and strays from that way by `stray` at most. Lengths are in the clouds' unit.
struct StraightWays {
  Eigen::Isometry3d middle = Eigen::Isometry3d::Identity();
  Eigen::Matrix3d turn = Eigen::Matrix3d::Zero(); ///< of half the ways
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  double stray = 0.0;

  Eigen::Vector3d half(const Eigen::Vector3d& p) const { return turn * p + shift; }
};

/// The least distance from the origin on the way from a place half a way back to one half a way on.
PCL_BSH_EXPORT_INTERNAL double leastOnWay(const Eigen::Vector3d& middle, const Eigen::Vector3d& half);

/// All pairs of records that come within the clearance on a's ways, in no particular order, and some that do not.
/// Points of these come nearly so near. Balls and triangles are found wherever the spheres of their leaves are not kept
/// apart.
/// @param request as pairsWithin() takes it @param most_leaf_pairs to compare; where there are more, the result is not
///   complete
PCL_BSH_EXPORT_INTERNAL PairsWithin
pairsAlong(const SphereHierarchy& a, const StraightWays& ways, const Placed& b, const ContactsRequest& request,
           std::uint64_t most_leaf_pairs = std::numeric_limits<std::uint64_t>::max());

} // namespace pcl_bsh
