// SPDX-License-Identifier: BSD-3-Clause
// The state of a walk along a trajectory at one node of the scan, as the model sees it.

#if defined(PCL_BSH_TRAJECTORY_NODE_VISIT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAJECTORY_NODE_VISIT_INL_H_
#undef PCL_BSH_TRAJECTORY_NODE_VISIT_INL_H_
#else
#define PCL_BSH_TRAJECTORY_NODE_VISIT_INL_H_
#endif

#include <pcl_bsh/trajectory/boxes/model_boxes-inl.h>
#include <pcl_bsh/trajectory/boxes/oriented_boxes-inl.h>
#include <pcl_bsh/traversal/list_walk-inl.h>

#include <algorithm>
#include <limits>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// A node of the scan that is tested against the model, all of its children at once.
struct NodeVisit : ListVisit<Siblings> {
  Segments<kLanes, 3> children;
  Segment around;
  float radius[kLanes];
  std::vector<Siblings> candidates; ///< boxes that any of them may meet
  // Set at one pose only: the children's boxes, and no less than the smallest distance of any of their points.
  alignas(64) float low[3][kLanes], high[3][kLanes], near_squared[kLanes], bound[kLanes];

  /// @param index of the node in its voxel
  void begin(const Node& entered, std::uint32_t index, const VoxelMotion& motion, const VoxelInModelFrame& voxel_frame,
             const OrientedBoxes& oriented_boxes)
  {
    ListVisit::begin(entered);
    alignas(64) float from[3][kLanes], to[3][kLanes], bow[3][kLanes];
    carry(motion.from.m, motion.from.g, entered.x, entered.y, entered.z, kLanes, from[0], from[1], from[2]);
    carry(motion.to.m, motion.to.g, entered.x, entered.y, entered.z, kLanes, to[0], to[1], to[2]);
    carry(motion.bow.m, motion.bow.g, entered.x, entered.y, entered.z, kLanes, bow[0], bow[1], bow[2]);
    children.set(from, to, bow, motion.smallest);
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) radius[lane] = voxel_frame.seenRadius(entered.r[lane]);
    alignas(64) float extent[3][kLanes];
    oriented_boxes.see(index, motion, radius, extent);
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::uint32_t lane = 0; lane < kLanes; ++lane)
        children.reach[axis][lane] = (motion.reach + extent[axis][lane]) * (1.0f + kReachMargin);
    children.ball = motion.reach * (1.0f + kReachMargin);
    around = voxel_frame.aroundSegments(motion, from, to, bow, extent, entered.count);
    if (!motion.at_rest) return;
    constexpr float unbounded = std::numeric_limits<float>::infinity();
    std::fill(bound, bound + kLanes, unbounded);
    std::fill(near_squared, near_squared + kLanes, voxel_frame.nearSquared(motion, unbounded));
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
        low[axis][lane] = from[axis][lane] - extent[axis][lane] * (1.0f + kReachMargin);
        high[axis][lane] = from[axis][lane] + extent[axis][lane] * (1.0f + kReachMargin);
      }
  }
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
