// SPDX-License-Identifier: BSD-3-Clause
// Which points of two posed clouds collide with something of the other cloud?
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/query/accuracy.h>
#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/query/result.h>

#include <cstddef>
#include <cstdint>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

enum class Side : std::uint8_t { a = 1, b = 2, both = 3 };

/// What collisionFlags() reads.
struct FlagsRequest {
  double clearance = 0.0; ///< finite, >= 0; inclusive
  Side flagged = Side::a; ///< whose points are flagged
  unsigned threads = 1;   ///< 0: all of the machine's
  Accuracy accuracy;      ///< exact, unless the caller asks for less
};

struct FlagsResult {
  /// One per record of a's view, a Verdict as a number: 0 free, 1 collides, 2 undecided, the latter only when the
  /// request's accuracy lets the walk stop early, or where points have uncertainties. Empty when not asked for.
  std::vector<std::uint8_t> a;
  std::vector<std::uint8_t> b; ///< likewise for b
  std::size_t colliding_a = 0;
  std::size_t colliding_b = 0;
  std::size_t undecided_a = 0;
  std::size_t undecided_b = 0;
  Work work;
};

/// Which points collide with something of the other cloud? Where points have uncertainties (PointsView), a point
/// collides if some point of the other cloud is within the clearance of it wherever both truly are; it is free if none
/// can be; else it is undecided. Several points of the other cloud of which always one is near, though not always the
/// same, leave it undecided. That costs about two queries; a budget is divided between them.
/// @throws std::invalid_argument when the clearance, the accuracy or a pose is not what its declaration asks for.
FlagsResult collisionFlags(const Placed& a, const Placed& b, const FlagsRequest& request);

/// The same into a result whose memory is used again: for one pose after another.
void collisionFlags(const Placed& a, const Placed& b, const FlagsRequest& request, FlagsResult& result);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
