// SPDX-License-Identifier: BSD-3-Clause
// Pairs of points that come near each other while one cloud moves a little.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/pairs/contacts.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <functional>
#include <limits>

namespace pcl_bsh {

/// The ways of a cloud's places. One that is at p in the cloud's frame is at start p + t way(p) while t runs from 0 to
/// 1, and strays from there by `stray` at most. Lengths are in the clouds' unit.
struct StraightWays {
  Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
  Eigen::Matrix3d turn = Eigen::Matrix3d::Zero(); ///< of the ways
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  double stray = 0.0;

  Eigen::Vector3d way(const Eigen::Vector3d& p) const { return turn * p + shift; }
};

/// The least distance from the origin on the way from a place.
PCL_BSH_EXPORT_INTERNAL double leastOnWay(const Eigen::Vector3d& from, const Eigen::Vector3d& way);

/// Takes a pair that was found. Returns the t up to which ways are of interest from now on, from 0 to 1. It may only
/// fall: the first of all meetings makes ways so short that little is left to compare.
using EndOfWays = std::function<double(PointPair)>;

/// Returns all pairs of records that come within the clearance on a's ways of interest, in no particular order, and
/// some that do not. Such pairs of points come nearly as near. Balls and triangles are returned wherever the spheres of
/// their leaves are not proven apart.
/// @param request as pairsWithin() takes it @param most_leaf_pairs to compare; where there are more, the result is not
///   complete @param end_of_ways called for each pair; null: all of each way is of interest
PCL_BSH_EXPORT_INTERNAL PairsWithin pairsAlong(
    const SphereHierarchy& a, const StraightWays& ways, const Placed& b, const ContactsRequest& request,
    std::uint64_t most_leaf_pairs = std::numeric_limits<std::uint64_t>::max(), const EndOfWays& end_of_ways = nullptr);

} // namespace pcl_bsh
