// SPDX-License-Identifier: BSD-3-Clause
// Poses near each other, which one task answers.
#pragma once

#include <pcl_bsh/query/reach.h>
#include <pcl_bsh/query/result.h>
#include <pcl_bsh/roadmap/collide_at_poses.h>
#include <pcl_bsh/roadmap/pose_order.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace pcl_bsh {

/// As many poses as one task answers: enough that what they have in common pays, few enough for many tasks.
inline constexpr std::size_t kBatchPoses = 256;

/// Motions about the poses of a batch.
class MotionsAbout {
public:
  virtual ~MotionsAbout() = default;

  /// Whether the pair collides at an instant of motion i. Where not, it may collide at another one.
  virtual bool collide(std::size_t i, const PointPair& pair, Work& work) const = 0;

  /// A pair that comes near enough during motion i to count as colliding. It is found if and only if there is one.
  virtual std::optional<PointPair> find(std::size_t i, Work& work) const = 0;

  std::vector<double> extents; ///< how far any point of b gets from where it is at each of the poses
  double tolerance = 0.0;      ///< a pair counts as colliding up to the clearance and so much more
};

/// Of one task.
struct PoseBatch {
  const Placed& a;
  const SphereHierarchy& b;
  const BodyBall& body;                  ///< of b
  std::vector<Eigen::Isometry3d> poses;  ///< of b, neighbours near each other
  const MotionsAbout* motions = nullptr; ///< null: b rests at its poses
};

/// Marks those poses of a batch at which points collide that are where `places` says, or on the motions about which
/// they do.
Work anyOfBatch(const PoseBatch& batch, const AnyRequest& request, Places places, bool* collides);

/// The closest pairs at its poses. @param order the poses' places in the result
Work closestOfBatch(const PoseBatch& batch, const std::uint32_t* order, DistancesAtPoses& result);

} // namespace pcl_bsh
