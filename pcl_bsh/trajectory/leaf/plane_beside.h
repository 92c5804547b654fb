// SPDX-License-Identifier: BSD-3-Clause
// A plane beside the whole model: where thousands of pairs of triangles are hardly farther apart than the reach, one
// look at a record of the scan stands for its pairs.
#pragma once

#include <pcl_bsh/geometry/triangle/separation.h>
#include <pcl_bsh/trajectory/query.h>
#include <pcl_bsh/traversal/plane_policy.h>

#include <cstdint>

namespace pcl_bsh {

/// A plane beside the model, once enough pairs were decided in vain. Its normal is the direction along which the
/// nearest of these pairs was apart. No plane is laid where records have radii or reaches of their own, nor where all
/// are points.
class PlaneBeside {
public:
  explicit PlaneBeside(const TrajectoryQuery& query);

  /// Takes note of a pair that does not collide at a pose. A plane is laid once such pairs have cost as much as it
  /// does.
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
  double least_;                 ///< lower bound of the distance of the nearest pair since the last plane
  Point3 direction_ = {0, 0, 0}; ///< along which that pair is apart
  Point3 normal_ = {0, 0, 0};    ///< from the model to the scan
  MovingCorners touching_ = {};  ///< the record of the model that reaches farthest along the normal
  PlanePolicy policy_;
  std::uint32_t number_ = 0;
  bool is_laid_ = false;
};

} // namespace pcl_bsh
