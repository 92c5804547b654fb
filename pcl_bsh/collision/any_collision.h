// SPDX-License-Identifier: BSD-3-Clause
// Does any pair of points of two posed clouds collide?
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/query/accuracy.h>
#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/query/result.h>

#include <optional>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// What anyCollision() reads.
struct AnyRequest {
  double clearance = 0.0; ///< finite, >= 0; inclusive
  Accuracy accuracy;      ///< exact, unless the caller asks for less
};

struct AnyResult {
  Verdict verdict = Verdict::free;  ///< undecided only when the request's accuracy lets the walk stop early
  std::optional<PointPair> witness; ///< a colliding pair, when colliding
  Interval distance;                ///< of the clouds, as far as the walk had to learn it
  Work work;
};

/// Does any pair of points collide? Stops at the first witness. One thread.
/// @throws std::invalid_argument when the clearance, the accuracy or a pose is not what its declaration asks for.
AnyResult anyCollision(const Placed& a, const Placed& b, const AnyRequest& request = {});

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
