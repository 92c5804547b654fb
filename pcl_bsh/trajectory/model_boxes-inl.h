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
namespace pcl_bsh {
namespace HWY_NAMESPACE {

/// A box of the model: a child of one of a voxel's nodes, or of the nodes above the voxels.
struct ModelBox {
  const BoxNode* boxes;
  std::uint32_t voxel;
  std::uint32_t node;
  std::uint32_t lane;
  std::uint32_t level; ///< of `node` below its voxel, from 1; 0: above

  const BoxNode& box() const { return boxes[node]; }
  bool isLeaf() const { return voxel != kAboveVoxels && box().isLeaf(lane); }
  /// Half of its longest side, where sides along the way count for less. @param stretch of the tree
  float size(const float (&stretch)[3]) const
  {
    float largest = 0.0f;
    for (std::size_t axis = 0; axis < 3; ++axis)
      largest = std::max(largest, (box().high[axis][lane] - box().low[axis][lane]) / stretch[axis]);
    return 0.5f * largest;
  }
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

/// Boxes by their distance from a point, those at the same distance as they come.
class BoxesByDistance {
public:
  /// @return valid until the next call
  const std::vector<ModelBox>& sort(const std::vector<ModelBox>& boxes, const Point& from)
  {
    order_.clear();
    for (std::uint32_t i = 0; i < boxes.size(); ++i) order_.emplace_back(BoxEnds(boxes[i]).squaredDistance(from), i);
    std::sort(order_.begin(), order_.end());
    sorted_.clear();
    for (const auto& [distance, i] : order_) sorted_.push_back(boxes[i]);
    return sorted_;
  }

private:
  std::vector<std::pair<float, std::uint32_t>> order_;
  std::vector<ModelBox> sorted_;
};

/// Opens the model's boxes.
class ModelBoxes {
public:
  ModelBoxes(const BoxTree& tree, const StopRule& rule, Work& work) : tree_(tree), rule_(rule), work_(work) {}

  /// The node above all boxes, as its first child.
  ModelBox root() const { return {tree_.top().data(), kAboveVoxels, 0, 0, 0}; }

  /// Whether a candidate that is not a leaf may be opened: not below the level where to stop, nor without the time to
  /// build a voxel.
  bool mayOpen(const ModelBox& c) const
  {
    if (!rule_.mayStop()) return true;
    if (c.voxel != kAboveVoxels) return c.level < rule_.deepest;
    if (!c.box().isLeaf(c.lane)) return true;
    return rule_.deepest > 0 && rule_.leavesTimeToBuild(tree_.storage.pointsToBuild(c.box().leaf(c.lane)));
  }

  /// The node below a candidate that is not a leaf, as its first child.
  ModelBox below(const ModelBox& c)
  {
    if (c.voxel != kAboveVoxels || !c.box().isLeaf(c.lane))
      return {c.boxes, c.voxel, c.box().child[c.lane], 0, c.voxel == kAboveVoxels ? 0 : c.level + 1};
    const std::uint32_t voxel = c.box().leaf(c.lane);
    return {tree_.voxel(voxel, work_).data(), voxel, 0, 0, 1};
  }

  /// Bits of the children of a node that a thick segment may meet.
  std::uint32_t near(const Segment& segment, const ModelBox& node, float steps)
  {
    const std::uint32_t count = node.box().count;
    work_.node_pairs += count;
    return boxesOnSegment(segment, node.box().low, node.box().high, steps) & firstBits(count);
  }

  /// What a thick segment may meet of the model below a node, in boxes no larger than `size`.
  void collect(const VoxelMotion& motion, const Segment& segment, float size, ModelBox node,
               std::vector<ModelBox>& into)
  {
    for (std::uint32_t bits = near(segment, node, motion.steps); bits != 0; bits &= bits - 1) {
      node.lane = static_cast<std::uint32_t>(std::countr_zero(bits));
      if (node.isLeaf() || node.size(tree_.stretch) < size || !mayOpen(node))
        into.push_back(node);
      else
        collect(motion, segment, size, below(node), into);
    }
  }

private:
  const BoxTree& tree_;
  const StopRule& rule_;
  Work& work_;
};

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle
