// SPDX-License-Identifier: BSD-3-Clause
// Which of many boxes come near a box? A tree over them, so that a question costs what it finds.
#pragma once

#include <pcl_bsh/clashes/extent.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_bsh {

class NearBoxes {
public:
  explicit NearBoxes(std::vector<Extent> boxes);

  /// Calls visit(i) for each box i within `nearness` of this one along each axis, in no particular order.
  /// @param visit returns true to take box i out: no later call visits it
  template <typename Visit>
  void visitNear(const Extent& box, double nearness, const Visit& visit)
  {
    if (!nodes_.empty()) visitNode(0, box, nearness, visit);
  }

  std::size_t left() const { return nodes_.empty() ? 0 : nodes_.front().left; } ///< boxes that are not taken out

  std::uint64_t compared = 0; ///< boxes and nodes, by all questions so far

private:
  static constexpr std::uint32_t leaf_size = 4;

  /// Its boxes are order_[begin, end). An inner node's first child is the next node.
  struct Node {
    Extent box;
    std::uint32_t begin = 0, end = 0;
    std::uint32_t second = 0; ///< 0: a leaf
    std::uint32_t left = 0;   ///< boxes that are not taken out
  };

  void build(std::uint32_t begin, std::uint32_t end);

  /// @return how many of its boxes were taken out
  template <typename Visit>
  std::uint32_t visitNode(std::uint32_t number, const Extent& box, double nearness, const Visit& visit)
  {
    Node& node = nodes_[number];
    if (node.left == 0) return 0;
    ++compared;
    if (!box.isNear(node.box, nearness)) return 0;
    std::uint32_t gone = 0;
    if (node.second != 0) {
      gone = visitNode(number + 1, box, nearness, visit);
      gone += visitNode(node.second, box, nearness, visit);
    }
    else {
      for (std::uint32_t i = node.begin; i < node.end; ++i) {
        if (is_gone_[order_[i]]) continue;
        ++compared;
        if (!box.isNear(boxes_[order_[i]], nearness) || !visit(std::size_t{order_[i]})) continue;
        is_gone_[order_[i]] = true;
        ++gone;
      }
    }
    node.left -= gone;
    return gone;
  }

  std::vector<Extent> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
  std::vector<bool> is_gone_;
};

} // namespace pcl_bsh
