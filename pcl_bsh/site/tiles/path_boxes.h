// SPDX-License-Identifier: BSD-3-Clause
// A tree of boxes over the path of a model, which tiles are compared with.
#pragma once

#include <pcl_bsh/site/tiles/cloud_boxes.h>

#include <Eigen/Geometry>

#include <vector>

namespace pcl_bsh::site {

/// The space about a model's points that counts, too.
struct PathReach {
  double distance = 0.0; ///< places within this distance count
  bool moves = false;    ///< the motion between poses counts, too; it turns about the origin of the model's frame
};

/// A binary tree of boxes about a model with its reach. A leaf is the box at one pose, or on the way from one pose to
/// the next; a box above holds two boxes, the uppermost the whole path. The model and the poses are borrowed.
class PathBoxes {
public:
  PathBoxes(const CloudBoxes& model, const std::vector<Eigen::Isometry3d>& poses, const PathReach& reach);

  /// Whether anything within a box may be within reach. Never false where a point of it is.
  bool mayReach(const Bounds& box) const;

  /// The box about all that is within reach. @pre the model has a point, and there is a pose
  const Bounds& whole() const { return levels_.back().front(); }

private:
  Bounds boxOf(const Bounds& part, std::size_t step) const;
  double shiftOf(std::size_t step) const;
  bool mayReach(const Bounds& box, std::size_t level, std::size_t index) const;

  const CloudBoxes& model_;
  const std::vector<Eigen::Isometry3d>& poses_;
  PathReach reach_;
  double arm_ = 0.0;                        ///< no part of the model is farther from its origin
  std::vector<std::vector<Bounds>> levels_; ///< boxes of steps, then of pairs of boxes below; empty: nothing to reach
};

} // namespace pcl_bsh::site
