// SPDX-License-Identifier: BSD-3-Clause
// Which points of two posed clouds collide with something of the other cloud?
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/query/effort.h>
#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/query/result.h>

#include <cstddef>
#include <cstdint>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The clouds whose points are flagged.
enum class Flagged : std::uint8_t { a = 1, b = 2, both = 3 };

/// Options of collisionFlags().
struct FlagsRequest : Effort {
  FlagsRequest() = default;
  /** All but the spacings. */ FlagsRequest(double within, Flagged whose = Flagged::a, Effort effort = {})
  : Effort(std::move(effort)),
    clearance(within),
    flagged(whose)
  {
  }

  double clearance = 0.0;       ///< finite, >= 0; inclusive
  Flagged flagged = Flagged::a; ///< whose points are flagged

  /// The density guard, for collisionFlags(): how far the samples of b's surface are apart at each record of its view
  /// (patchSpacings() in neighbors/patch_spacings.h), finite and >= 0, equal at the same place; null: no guard. A patch
  /// is the ball about a point of b whose diameter is its spacing. A point of a that is free, but within the clearance
  /// of a patch (wherever points truly are), is Verdict::sparse instead of free. It is no farther from some point of b
  /// than the clearance and half of that point's spacing.
  ///
  /// Promised: no place of b's surface is within the clearance of a free point that stays free, if each place of that
  /// surface is in a patch. Not promised: that the patches cover it. The guard says nothing of holes wider than the
  /// spacings, of what nobody scanned, and of gaps between the samples of a, whose surface it does not know.
  const float* spacings_of_b = nullptr;
};

/// Result of collisionFlags().
struct FlagsResult {
  /// One per record of a's view: undecided only when the request's accuracy lets the walk stop early, or where points
  /// have uncertainties; sparse only with a density guard. Empty when not asked for.
  std::vector<Verdict> a;
  std::vector<Verdict> b; ///< one per record of b's view; sparse never
  std::size_t colliding_a = 0;
  std::size_t colliding_b = 0;
  std::size_t undecided_a = 0;
  std::size_t undecided_b = 0;
  std::size_t sparse_a = 0; ///< not among the undecided
  Work work;
};

/// Which points collide with something of the other cloud? Where points have uncertainties (PointsView), a point
/// collides if some point of the other cloud is within the clearance of it wherever both truly are. It is free if no
/// point can be within it; else it is undecided. Several points of the other cloud of which always one is near, though
/// not always the same, leave it undecided. One search finds all three verdicts; a density guard is one search more.
/// @throws std::invalid_argument when the clearance, the accuracy, a spacing or a pose is not what its declaration asks
///   for. Cancelled.
FlagsResult collisionFlags(const Placed& a, const Placed& b, const FlagsRequest& request);

/// Writes into a result whose memory is used again: for one pose after another.
void collisionFlags(const Placed& a, const Placed& b, const FlagsRequest& request, FlagsResult& result);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
