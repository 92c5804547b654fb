// SPDX-License-Identifier: BSD-3-Clause
// The descent that queries for all points share. A node of a goes down with a list of the items of b that may matter to
// it. A visitor makes the lists of its children, and compares leaves.

#if defined(PCL_BSH_TRAVERSAL_LIST_WALK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAVERSAL_LIST_WALK_INL_H_
#undef PCL_BSH_TRAVERSAL_LIST_WALK_INL_H_
#else
#define PCL_BSH_TRAVERSAL_LIST_WALK_INL_H_
#endif

#include <pcl_bsh/query/stop_rule.h>
#include <pcl_bsh/traversal/leaf_pair-inl.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// A sphere of b that matters to the points of some node of a: a child of `node`, in one of the spaces of b that the
/// walk has numbered.
struct ObstacleSphere {
  const Node* node;
  std::uint16_t lane;
  std::uint16_t level; ///< of `node` below its voxel, from 1; 0 above the voxels
  std::uint32_t obstacle;

  bool isLeaf() const { return node->isLeaf(lane); }
  ObstacleSphere below(const Node& child, std::uint32_t i) const
  {
    return {&child, static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(level + 1), obstacle};
  }
  LeafRange leaf(const Voxel& voxel) const { return {&voxel, node->begin[lane], node->comparedPoints(lane)}; }

  /// Returns the sphere with its slab and its cross slab.
  /// @param slabs, cross those of the voxel; `cross` is null where there is one slab only
  /// @param stretch factor of radii
  CrossedSlabs between(const Voxel& voxel, const Slabs* slabs, const Slabs* cross, float stretch) const
  {
    const auto index = node - voxel.nodes.data();
    const Slabs& own = slabs[index];
    CrossedSlabs held{{own.x[lane], own.y[lane], own.z[lane]},       {0.0f, 0.0f, 0.0f},     own.h[lane], 0.0f,
                      {node->x[lane], node->y[lane], node->z[lane]}, node->r[lane] * stretch};
    if (!cross) return held;
    held.cross = {cross[index].x[lane], cross[index].y[lane], cross[index].z[lane]};
    held.cross_h = cross[index].h[lane];
    return held;
  }
};

/// A sphere in the frame of a's voxel.
struct BoundingSphere {
  Point center;
  float radius;
};

/// The state of a walk at one node of a. Visitors add what they need.
template <class Item>
struct ListVisit {
  const Node* node = nullptr;
  std::uint32_t leaves = 0;       ///< bits of the children that are leaves
  std::vector<Item> near[kLanes]; ///< items of b that may matter to each child

  void begin(const Node& entered)
  {
    node = &entered;
    leaves = 0;
    for (std::uint32_t lane = 0; lane < entered.count; ++lane) {
      near[lane].clear();
      if (entered.isLeaf(lane)) leaves |= 1u << lane;
    }
  }

  std::size_t bytes() const noexcept
  {
    std::size_t sum = 0;
    for (const auto& list : near) sum += list.capacity() * sizeof(Item);
    return sum;
  }
};

/// A walk's visits by depth, kept for later walks. References to shallower visits stay in use while deeper ones are
/// added.
template <class Visit>
class Visits {
public:
  /// @pre depth is at most one more than the greatest depth asked for before
  Visit& at(std::size_t depth)
  {
    if (by_depth_.size() == depth) by_depth_.emplace_back();
    return by_depth_[depth];
  }

  std::size_t bytes() const noexcept
  {
    std::size_t sum = by_depth_.size() * sizeof(Visit);
    for (const Visit& visit : by_depth_) sum += visit.bytes();
    return sum;
  }

private:
  std::deque<Visit> by_depth_;
};

/// A node of a, and a sphere around all that it holds.
struct NodeInSphere {
  const Node& node;
  BoundingSphere around;

  static NodeInSphere rootOf(const Voxel& voxel) { return {voxel.nodes[0], {{0.0f, 0.0f, 0.0f}, voxel.radius}}; }

  NodeInSphere child(const Voxel& voxel, std::uint32_t lane) const
  {
    return {voxel.nodes[node.child[lane]], {{node.x[lane], node.y[lane], node.z[lane]}, node.r[lane]}};
  }
};

/// Defaults of visitors.
template <class Visit>
struct ListVisitor {
  /// Returns true after it took the node in smaller parts, by calling descend(part) for each; else false.
  template <class Part, class Descend>
  static bool divides(const Part&, const Descend&)
  {
    return false;
  }

  /// Returns the child that is visited as the i-th.
  static std::uint32_t childAt(const Visit&, std::uint32_t i) { return i; }

  /// Whether a child is still of interest when its turn comes.
  static bool wants(const Visit&, std::uint32_t) { return true; }

  /// Called where no item of b matters to a child.
  static void alone(const Visit&, std::uint32_t) {}

  /// Called for a child that is a leaf, with its parent's depth. Visitors without this compare leaves in refine().
  template <class Part>
  static void compare(const Part&, const Visit&, std::uint32_t, std::size_t)
  {
  }

  /// Called when all below an inner child is done.
  template <class Part>
  static void settled(const Part&, std::uint32_t)
  {
  }
};

/// The descent: depth first, until all is settled, too deep, or the rule ends it.
/// @tparam Visit a ListVisit
template <class Visit>
class ListWalk {
public:
  /// @param tested counts the walk's sphere tests
  ListWalk(const StopRule& rule, const std::uint64_t& tested, Visits<Visit>& visits)
  : stop_check(rule, tested),
    rule_(rule),
    visits_(visits)
  {
  }

  /// Tests the list of a node of a against all its children at once; then descends into each child with its own list.
  /// @tparam Visitor a ListVisitor that has
  ///   `void left(part, list)`: a node stays undecided
  ///   `std::uint32_t refine(visit, part, list)`: begins the visit, and sets the lists of the children that it returns
  ///   `Part below(part, visit, lane)`: an inner child on its way down
  /// @tparam Part has the `node`, and what the visitor hands down with it @tparam List of items of the visit
  template <class Visitor, class Part, class List>
  void descend(Visitor& visitor, const Part& part, const List& list, std::size_t depth = 0)
  {
    if (stop_check.isOver() || depth >= rule_.deepest) return visitor.left(part, list);
    if (visitor.divides(part, [&](const Part& smaller) { descend(visitor, smaller, list, depth); })) return;
    Visit& visit = visits_.at(depth);
    const std::uint32_t children = visitor.refine(visit, part, list);
    for (std::uint32_t i = 0; children != 0 && i < part.node.count; ++i) {
      const std::uint32_t lane = visitor.childAt(visit, i);
      if ((children >> lane & 1) == 0 || !visitor.wants(visit, lane)) continue;
      if (visit.near[lane].empty()) {
        visitor.alone(visit, lane);
      }
      else if (part.node.isLeaf(lane)) {
        visitor.compare(part, visit, lane, depth);
      }
      else {
        descend(visitor, visitor.below(part, visit, lane), visit.near[lane], depth + 1);
        visitor.settled(part, lane);
      }
    }
  }

  StopCheck stop_check;

private:
  const StopRule& rule_;
  Visits<Visit>& visits_;
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
