// SPDX-License-Identifier: BSD-3-Clause
// Smallest distance between two posed clouds, in double: what places the poses, and judges the answers of all racers.
#pragma once

#include "points.h"

#include <array>
#include <limits>

namespace pcl_bsh::bench {

/// A k-d tree with a box in every node, median splits, leaves of a few points: plain, and independent of everything
/// that is raced.
class ReferenceTree {
public:
  explicit ReferenceTree(const Points& points);

  /// Smallest distance to `other` posed by `pose` in this tree's frame, if it is at most `bound`; else `bound`.
  double distance(const ReferenceTree& other, const RigidPose& pose,
                  double bound = std::numeric_limits<double>::infinity()) const;

  /// Radius about the frame's origin that holds every point.
  double reach() const { return reach_; }

private:
  struct Node {
    std::array<double, 3> centre, half; // of the box
    double radius;                      // of the sphere about it
    std::uint32_t begin, end;           // points
    std::uint32_t right;                // child; the left one follows its parent. 0: a leaf
  };
  struct Descent;

  std::uint32_t split(std::uint32_t begin, std::uint32_t end);

  std::vector<Node> nodes_;
  Points points_;
  double reach_ = 0.0;
};

} // namespace pcl_bsh::bench
