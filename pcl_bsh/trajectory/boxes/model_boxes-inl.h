// SPDX-License-Identifier: BSD-3-Clause
// The model's side of a walk along a trajectory: its boxes, opened as they are needed.

#if defined(PCL_BSH_TRAJECTORY_MODEL_BOXES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAJECTORY_MODEL_BOXES_INL_H_
#undef PCL_BSH_TRAJECTORY_MODEL_BOXES_INL_H_
#else
#define PCL_BSH_TRAJECTORY_MODEL_BOXES_INL_H_
#endif

#include <pcl_bsh/query/stop_rule.h>
#include <pcl_bsh/trajectory/voxel_in_model_frame-inl.h>

#include <algorithm>
#include <utility>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// A box of the model: a child of one of a voxel's nodes, or of the nodes above the voxels.
struct ModelBox {
  const BoxNode* boxes;
  std::uint32_t voxel;
  std::uint32_t node;
  std::uint32_t lane;
  std::uint32_t level; ///< of `node` below its voxel, from 1; 0: above

  const BoxNode& box() const { return boxes[node]; }
  bool isLeaf() const { return voxel != kAboveVoxels && box().isLeaf(lane); }
  /// Returns the points of a leaf.
  BoxLeaf points(const BoxTree& tree) const { return tree.leaf(voxel, box().leaf(lane)); }
  /// Half of its longest side, where sides along the way count for less. @param stretch of the tree
  float size(const float (&stretch)[3]) const
  {
    float largest = 0.0f;
    for (std::size_t axis = 0; axis < 3; ++axis)
      largest = std::max(largest, (box().high[axis][lane] - box().low[axis][lane]) / stretch[axis]);
    return 0.5f * largest;
  }
};

/// Some of the boxes of a node, tested eight at once.
struct Siblings {
  const BoxNode* boxes;
  std::uint32_t voxel;
  std::uint32_t node;
  std::uint32_t lanes; ///< bits of the boxes
  std::uint32_t level; ///< as ModelBox has it

  const BoxNode& box() const { return boxes[node]; }
  ModelBox operator[](std::uint32_t lane) const { return {boxes, voxel, node, lane, level}; }
  Siblings only(std::uint32_t some) const { return {boxes, voxel, node, some, level}; }
};

/// Where a box ends along each axis.
struct BoxEnds {
  float low[3], high[3];

  explicit BoxEnds(const ModelBox& candidate)
  {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = candidate.box().low[axis][candidate.lane];
      high[axis] = candidate.box().high[axis][candidate.lane];
    }
  }

  float squaredDistance(const Point& p) const
  {
    const float at[3] = {p.x, p.y, p.z};
    float squared = 0.0f;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float away = std::max({low[axis] - at[axis], at[axis] - high[axis], 0.0f});
      squared += away * away;
    }
    return squared;
  }
};

/// Sorts boxes by their distance from a point. Boxes at equal distances keep their order.
class BoxesByDistance {
public:
  /// @param into becomes the boxes, an entry each, nearest first
  void sort(const std::vector<Siblings>& boxes, const Point& from, std::vector<Siblings>& into)
  {
    order_.clear();
    into.clear();
    for (const Siblings& some : boxes)
      for (const std::uint32_t lane : Bits(some.lanes)) {
        const BoxEnds box(some[lane]);
        order_.emplace_back(box.squaredDistance(from), static_cast<std::uint32_t>(sorted_.size()));
        sorted_.push_back(some.only(1u << lane));
      }
    std::sort(order_.begin(), order_.end());
    for (const auto& [distance, i] : order_) into.push_back(sorted_[i]);
    sorted_.clear();
  }

private:
  std::vector<std::pair<float, std::uint32_t>> order_;
  std::vector<Siblings> sorted_;
};

/// A ball around a place in the scan's voxel, at a pose; its reach in the clouds' unit.
struct ProbeSphere {
  Point center;
  float reach;
  std::uint32_t pose;
  float scale = 0.0f;   ///< a point's own uncertainty, times this, is added to the reach; may be below 0
  float farther = 0.0f; ///< how much that makes the reach longer at most
};

/// Opens the model's boxes.
class ModelBoxes {
public:
  ModelBoxes(const BoxTree& tree, const StopRule& rule, Work& work) : tree_(tree), rule_(rule), work_(work) {}

  /// The boxes of the node above all of them.
  Siblings root() const { return all({tree_.top().data(), kAboveVoxels, 0, 0, 0}); }

  /// Whether a candidate that is not a leaf may be opened: not below the level where to stop, nor without the time to
  /// build a voxel.
  bool mayOpen(const ModelBox& c) const
  {
    if (!rule_.mayStop()) return true;
    if (c.voxel != kAboveVoxels) return c.level < rule_.deepest;
    if (!c.box().isLeaf(c.lane)) return true;
    return rule_.mayEnter([&] { return tree_.storage.pointsToBuild(c.box().leaf(c.lane)); });
  }

  /// Whether a box is so small that floats do not tell the boxes below it apart during the motion, and holds many
  /// points. Then it is quicker to compare each point of the scan with the model's spheres (model_descent.h).
  bool isBlunt(const ModelBox& c, const VoxelMotion& motion) const
  {
    return !c.isLeaf() && c.size(tree_.stretch) < motion.blunt && !rule_.mayStop() && holdsMany(c);
  }

  /// The boxes of the node below a candidate that is not a leaf.
  Siblings below(const ModelBox& c)
  {
    if (c.voxel != kAboveVoxels || !c.box().isLeaf(c.lane))
      return all({c.boxes, c.voxel, c.box().child[c.lane], 0, c.voxel == kAboveVoxels ? 0 : c.level + 1});
    const std::uint32_t voxel = c.box().leaf(c.lane);
    return all({tree_.voxel(voxel, work_).boxes().data(), voxel, 0, 0, 1});
  }

  /// Returns the boxes of a candidate that a thick segment may meet.
  Siblings near(const Segment& segment, const Siblings& candidate, float steps)
  {
    work_.node_pairs += static_cast<std::uint64_t>(std::popcount(candidate.lanes));
    return candidate.only(candidate.lanes & boxesOnSegment(segment, candidate.box().low, candidate.box().high, steps));
  }

  /// Collects the boxes of all candidates that a thick segment may meet.
  void near(const Segment& segment, const std::vector<Siblings>& candidates, float steps, std::vector<Siblings>& into)
  {
    into.clear();
    for (const Siblings& candidate : candidates)
      if (const Siblings met = near(segment, candidate, steps); met.lanes != 0) into.push_back(met);
  }

  /// Collects boxes, of these and below, that a thick segment may meet during the motion. Boxes are opened until they
  /// are smaller than `size`, except leaves, blunt boxes and boxes that may not be opened.
  void collect(const Segment& segment, const VoxelMotion& motion, float size, const Siblings& boxes,
               std::vector<Siblings>& into)
  {
    std::uint32_t kept = 0;
    for (const std::uint32_t lane : Bits(near(segment, boxes, motion.steps).lanes)) {
      const ModelBox box = boxes[lane];
      if (box.isLeaf() || box.size(tree_.stretch) < size || isBlunt(box, motion) || !mayOpen(box))
        kept |= 1u << lane;
      else
        collect(segment, motion, size, below(box), into);
    }
    if (kept != 0) into.push_back(boxes.only(kept));
  }

  /// Whether the model has a point in the probe, in a candidate: one look that may settle a whole node of the scan. The
  /// nearest boxes are asked first. Where floats do not tell boxes apart during the motion, one of them alone is asked:
  /// then the answer may be false although there is a point.
  /// @param center of the probe, about where the model sees it.
  bool hasPoint(const VoxelInModelFrame& voxel_frame, const ModelBox& candidate, const ProbeSphere& probe,
                const Point& center, const VoxelMotion& motion)
  {
    if (candidate.isLeaf()) {
      if (tree_.unit(candidate.voxel) != 1.0) return false;
      const BoxLeaf leaf = candidate.points(tree_);
      const AffineMap map = voxel_frame.mapAt(voxel_frame.path.poses[probe.pose], tree_.offset(candidate.voxel), 1.0);
      for (const float g : map.g)
        if (!(std::abs(g) <= voxel_frame.far)) return false;
      const Point at = carryPoint(map.m, map.g, probe.center);
      if (leaf.lengths)
        return anyPointWithinEach(leaf.x(), leaf.y(), leaf.z(), leaf.lengths, probe.scale, leaf.count, at, probe.reach);
      return anyPointWithin(leaf.x(), leaf.y(), leaf.z(), leaf.count, at.x, at.y, at.z, probe.reach);
    }
    if (!mayOpen(candidate)) return false;
    const Siblings children = below(candidate);
    work_.node_pairs += static_cast<std::uint64_t>(std::popcount(children.lanes));
    float distance[kLanes];
    const float reach = probe.reach + probe.farther;
    std::uint32_t near = 0;
    for (std::uint32_t lane = 0; lane < children.box().count; ++lane) {
      distance[lane] = BoxEnds(children[lane]).squaredDistance(center);
      if (distance[lane] <= reach * reach) near |= 1u << lane;
    }
    while (near != 0) {
      auto nearest = static_cast<std::uint32_t>(std::countr_zero(near));
      for (const std::uint32_t lane : Bits(near & (near - 1)))
        if (distance[lane] < distance[nearest]) nearest = lane;
      if (hasPoint(voxel_frame, children[nearest], probe, center, motion)) return true;
      if (isBlunt(candidate, motion)) return false;
      near &= ~(1u << nearest);
    }
    return false;
  }

private:
  static constexpr std::uint32_t kManyLeaves = 3; ///< fewer are compared as quickly in floats

  static Siblings all(const Siblings& boxes) { return boxes.only(firstBits(boxes.box().count)); }

  /// Whether a box that is not a leaf has many leaves below it, or above the voxels the points of as many.
  bool holdsMany(const ModelBox& c) const
  {
    if (c.voxel == kAboveVoxels) {
      const Node& node = tree_.storage.top[c.node];
      const Voxel &first = tree_.storage.voxels[node.begin[c.lane]],
                  &last = tree_.storage.voxels[node.begin[c.lane + 1] - 1];
      return last.begin + last.count - first.begin > kManyLeaves * kMaxLeafPoints;
    }
    const BoxNode *first = &c.boxes[c.box().child[c.lane]], *last = first;
    while (!first->isLeaf(0)) first = &c.boxes[first->child[0]];
    while (!last->isLeaf(last->count - 1)) last = &c.boxes[last->child[last->count - 1]];
    return last->leaf(last->count - 1) - first->leaf(0) >= kManyLeaves; // leaves are numbered in order
  }

  const BoxTree& tree_;
  const StopRule& rule_;
  Work& work_;
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
