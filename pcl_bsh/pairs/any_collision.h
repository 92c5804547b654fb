// SPDX-License-Identifier: BSD-3-Clause
// Does any pair of points of two posed clouds collide?
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/query/effort.h>
#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/query/result.h>

#include <optional>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Options of anyCollision().
struct AnyRequest : Effort {
  AnyRequest() = default;
  /** Sets all. */ AnyRequest(double within, Effort effort = {}) : Effort(std::move(effort)), clearance(within) {}

  double clearance = 0.0; ///< finite, >= 0; inclusive
};

/// Result of anyCollision().
struct AnyResult {
  Verdict verdict = Verdict::free; ///< undecided only when the request's accuracy lets the walk stop early,
                                   ///< or where points have uncertainties
  /// A colliding pair, when colliding: the first that the depth-first search meets, for any number of threads.
  std::optional<PointPair> pair;
  Interval interval; ///< holds the distance of the clouds, as far as the walk had to learn it
  Work work;
};

/// Does any pair of points collide? Where points have uncertainties (PointsView): is some pair within the clearance
/// wherever its points truly are, can none be (free), or neither (undecided)? Stops at the first witness. Several
/// threads share a search that takes longer than about 0.05 ms. Its work is that of one thread, with two exceptions.
/// Other threads may have entered, and so built, voxels behind the witness. Where hundreds of triangles are hardly
/// farther apart than the clearance, each thread has to find that out. Accuracies that stop early take one thread.
/// @throws std::invalid_argument when the clearance, the accuracy or a pose is not what its declaration asks for.
///   Cancelled.
AnyResult anyCollision(const Placed& a, const Placed& b, const AnyRequest& request = {});

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
