// SPDX-License-Identifier: BSD-3-Clause
// Two moving parts: when they first collide, and which of their points collide at all.
#pragma once

#include <pcl_bsh/hierarchy/record_corners.h>
#include <pcl_bsh/pairs/contacts.h>
#include <pcl_bsh/query/reach.h>
#include <pcl_bsh/scene/swept/conservative_advancement.h>
#include <pcl_bsh/scene/swept/object_motion.h>

#include <optional>

namespace pcl_bsh {

/// A part of a moving object.
struct SweptPart {
  const SphereHierarchy& hierarchy;
  const Eigen::Isometry3d& pose; ///< T_object_cloud
  const ObjectMotion& motion;

  Placed at(double s) const { return {hierarchy, motion.at(s) * pose}; }

  /// A point, or a triangle, in the object's frame.
  Corners corners(std::uint32_t record) const { return placedBy(pose, cornersOf(hierarchy.view(), record)); }
};

struct PairContact {
  double s = 0.0;
  PointPair pair;
};

/// Pairs that a query may collect before the interval is halved instead.
inline constexpr std::size_t kMostPairs = 1 << 15;

/// An interval in which an object turns by more than this is halved while more than a few pairs can meet in it. To look
/// for pairs anew costs less than to follow pairs that are far apart for most of a turn.
inline constexpr double kWideTurn = 1.0; // radians
inline constexpr std::size_t kFewToTurn = 64;

/// No distance of a point of one to a point of the other shrinks by more than this within an interval of s.
double closingReach(const ObjectMotion& a, const ObjectMotion& b, double length);

/// Returns the first s in [0, 1] at which two points, placed as `places` says, are within clearance + tolerance and
/// come nearer; at no smaller s do any collide.
std::optional<PairContact> firstContactOf(const SweptPart& a, const SweptPart& b, double clearance, double tolerance,
                                          MeantPlaces places, Work& work);

/// Flags, one per record, the points that collide with one of the other part at some s in [0, 1], placed as `places`
/// says. A point farther than clearance + tolerance at all s is not flagged.
void flagContacts(const SweptPart& a, const SweptPart& b, double clearance, double tolerance, MeantPlaces places,
                  std::vector<Verdict>& flags_a, std::vector<Verdict>& flags_b, Work& work);

} // namespace pcl_bsh
