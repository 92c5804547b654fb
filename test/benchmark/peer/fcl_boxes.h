// SPDX-License-Identifier: BSD-3-Clause
// FCL's oriented boxes over points: the figure to beat for one rigid body against another.
#pragma once

#include "../workload/points.h"

#include <memory>

namespace pcl_bsh::bench {

/// fcl::BVHModel<fcl::OBBRSS> of single points. FCL rejects point models in its own queries, so the traversal is
/// written by hand over FCL's tree and FCL's box tests: the best FCL can do, not what it offers.
class FclBoxes {
public:
  explicit FclBoxes(const Points& points);
  ~FclBoxes();
  FclBoxes(FclBoxes&&) noexcept;

  /// Does a pair lie within d, `other` posed in this one's frame? Oriented boxes grown by d; stops at the first pair.
  bool any(const FclBoxes& other, const RigidPose& pose, double d) const;

  /// Smallest distance, by rectangle swept spheres, the nearer child first.
  double distance(const FclBoxes& other, const RigidPose& pose) const;

private:
  struct Model;
  std::unique_ptr<Model> model_;
};

} // namespace pcl_bsh::bench
