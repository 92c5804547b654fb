// SPDX-License-Identifier: BSD-3-Clause
// A model, its way, and the scan it passes.
#pragma once

#include "points.h"

#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace pcl_bsh::bench {

struct PathScene {
  Points scan;
  Points model;
  std::vector<Eigen::Isometry3d> poses; ///< of the model in the scan's frame
  double clearance = 0.0;
};

/// "tunnel": a railway wagon in a tunnel (examples/tunnel): the model fills its box. "tight": this wagon in one long
/// bend whose vault grazes its upper edges, points in random order. "crane": a carriage in an aisle of a store, driving
/// and slewing, its mast and its jib above the racks. Its box is full of racks that it never nears. 15 M scan points, 1
/// M model points, 10,000 poses at scale 1.
/// @param denser how many times as many poses over the same way
/// @throws std::invalid_argument for another name
PathScene pathScene(const std::string& name, double scale, double denser = 1.0);

inline RigidPose rigidPose(const Eigen::Isometry3d& pose)
{
  RigidPose result;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t k = 0; k < 3; ++k) result.rotation[3 * i + k] = pose.matrix()(row, static_cast<Eigen::Index>(k));
    result.translation[i] = pose.matrix()(row, 3);
  }
  return result;
}

} // namespace pcl_bsh::bench
