// SPDX-License-Identifier: BSD-3-Clause
// A plane beside the whole model: where thousands of pairs of triangles are hardly farther apart than the reach, one
// look at a record of the scan stands for its pairs.
#pragma once

#include <pcl_bsh/geometry/triangle/separation.h>
#include <pcl_bsh/trajectory/query.h>
#include <pcl_bsh/traversal/plane_policy.h>

#include <cstdint>

namespace pcl_bsh {

/// Its normal is the direction along which the nearest of the pairs was apart that were decided in vain. Knows nothing
/// where records have radii or reaches of their own, nor where all are points.
class PlaneBeside {
public:
  explicit PlaneBeside(const TrajectoryQuery& query);

  /// Takes note of a pair that does not collide at a pose. These pay for a plane.
  void decidedInVain(const Separation& apart)
  {
    if (!may_know_) return;
    if (apart.low > 0.0 && apart.low < least_) {
      least_ = apart.low;
      direction_ = apart.direction;
    }
    policy_.decidedInVain();
    if (policy_.begins()) lay();
  }

  /// Counts the planes laid so far; 0 while no plane is laid.
  std::uint32_t number() const { return is_laid_ ? number_ : 0; }

  /// Whether a record of the scan stays farther than a distance from all of the model, on its arcs. @pre number() != 0
  bool isBeside(const MovingCorners& arcs, double distance);

private:
  void lay();

  const TrajectoryQuery& query_;
  const bool may_know_;
  const double error_;           ///< of places along the normal
  double least_;                 ///< distance of the nearest of the pairs since the last plane, at least
  Point3 direction_ = {0, 0, 0}; ///< along which it is apart
  Point3 normal_ = {0, 0, 0};    ///< from the model to the scan
  MovingCorners touching_ = {};  ///< the record of the model that reaches farthest along the normal
  PlanePolicy policy_;
  std::uint32_t number_ = 0;
  bool is_laid_ = false;
};

} // namespace pcl_bsh
