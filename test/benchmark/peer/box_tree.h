// SPDX-License-Identifier: BSD-3-Clause
// The rival that papers on bounding spheres compare with: trees of axis-aligned boxes, descended together.
#pragma once

#include "../workload/points.h"

#include <array>
#include <cstdint>
#include <vector>

namespace pcl_bsh::bench {

/// As papers count: tests of bounding volumes (N_v), and how many were carried into the other tree's frame (N_u).
struct BoxWork {
  std::uint64_t tests = 0, updates = 0, leaf_pairs = 0;
};

/// A binary tree: boxes cut at the median of their longest axis, down to leaves of at most 16 points.
class BoxTree {
public:
  static constexpr std::uint32_t kLeafPoints = 16;

  struct Node {
    std::array<float, 3> centre, half; ///< of the box
    std::uint32_t begin, end;          ///< its points
    std::uint32_t child;               ///< the first of two; 0: a leaf
    std::uint32_t parent;

    bool isLeaf() const { return child == 0; }
    std::uint32_t count() const { return end - begin; }
  };

  explicit BoxTree(const Points& points);

  const std::vector<Node>& nodes() const { return nodes_; }
  const Points& points() const { return points_; }                     ///< in the order of the leaves
  const std::vector<std::uint32_t>& records() const { return order_; } ///< of points(): places in what was given

private:
  void fit(Node& node) const;

  Points points_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

/// Two trees, and the scratch memory of questions about them. Boxes of b are carried when they are first needed at
/// a pose. The middle is moved, and the half edges become |R| times as long (as in Cohen, Lin, Manocha, Ponamgi
/// 1995).
class BoxPair {
public:
  BoxPair(const BoxTree& a, const BoxTree& b);

  /// Is any point of a within d of a point of b, which stands at a pose in a's frame?
  bool any(const RigidPose& pose, float d, BoxWork& work);

  /// Which points of a are? Whole boxes count where their farthest corners are within d, and boxes of which all points
  /// are flagged are not opened. @param flags one of each of a's points, 0 or 1
  void flag(const RigidPose& pose, float d, std::vector<std::uint8_t>& flags, BoxWork& work);

private:
  template <typename Visit>
  void descend(const RigidPose& pose, float d, BoxWork& work, bool whole, const Visit& visit);
  void carry(const RigidPose& pose, std::uint32_t node, BoxWork& work);
  const Point* leafOfB(const RigidPose& pose, const BoxTree::Node& leaf);
  void settle(const BoxTree::Node& node, std::vector<std::uint8_t>& flags);
  void setFlag(std::uint32_t place, std::uint32_t leaf, std::vector<std::uint8_t>& flags);

  const BoxTree &a_, &b_;
  std::vector<BoxTree::Node> carried_;
  std::vector<std::uint8_t> is_carried_, is_moved_; ///< nodes of b; points of b, by the first of their leaf
  std::vector<std::uint32_t> touched_, moved_from_; ///< to be forgotten after the question
  Points moved_;
  std::vector<std::uint32_t> unflagged_; ///< of each node of a
};

} // namespace pcl_bsh::bench
