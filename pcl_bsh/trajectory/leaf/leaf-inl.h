// SPDX-License-Identifier: BSD-3-Clause
// A leaf of the scan against leaves of the model: at which poses, or instants, their points collide.

#if defined(PCL_BSH_TRAJECTORY_LEAF_LEAF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAJECTORY_LEAF_LEAF_INL_H_
#undef PCL_BSH_TRAJECTORY_LEAF_LEAF_INL_H_
#else
#define PCL_BSH_TRAJECTORY_LEAF_LEAF_INL_H_
#endif

#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/trajectory/leaf/arcs_at_poses-inl.h>
#include <pcl_bsh/trajectory/leaf/record_leaf-inl.h>
#include <pcl_bsh/trajectory/leaf/swept_leaf-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

inline constexpr double kLeafStray = 0.01; ///< of a leaf's radius: an interval that strays farther is divided
/// A smaller share where distances count: arcs do not tell apart pairs whose distances differ by less than their stray.
inline constexpr double kMeasuredStray = 0.003;
inline constexpr float kFewPoses = 4; ///< as quickly looked at one by one as all together

/// Compares leaves of the scan with the boxes of the model that they may meet.
class LeafWalk {
public:
  LeafWalk(const TrajectoryQuery& query, const VoxelInModelFrame& voxel_frame, ModelBoxes& model, StopCheck& stop_check,
           WorkPulse& pulse, VoxelResults& results, LongTriangles& long_triangles)
  : query_(query),
    voxel_frame_(voxel_frame),
    model_(model),
    stop_check_(stop_check),
    pulse_(pulse),
    results_(results),
    swept_(query, voxel_frame, results, compared_),
    at_pose_(query, voxel_frame, results),
    on_arcs_(query, voxel_frame, results, at_pose_),
    records_(query, voxel_frame, results, at_pose_, compared_, long_triangles)
  {
  }

  /// @param bound no less than the smallest distance of any of the points, where `motion` is one pose
  /// @return whether any of the leaf's points is not settled.
  bool compare(std::size_t slot, const LeafRange& points, const Node& node, std::uint32_t lane,
               const VoxelMotion& motion, const std::vector<Siblings>& candidates, float bound)
  {
    const std::uint32_t all = firstBits(points.count);
    if ((all & ~results_.settled[slot]) == 0 || results_.witness) return false;
    const double share = query_.everything() ? kMeasuredStray : kLeafStray;
    const double limit = query_.path.is_swept ? query_.path.stray : share * node.r[lane] * voxel_frame_.frame.unit;
    if (motion.interval->divided() && (query_.path.is_swept ? motion.line_stray : motion.stray) > limit) {
      return compare(slot, points, node, lane, voxel_frame_.motionOf(motion.interval->left), candidates, bound) &&
             compare(slot, points, node, lane, voxel_frame_.motionOf(motion.interval->right), candidates, bound);
    }
    if (hasPlane() && isWorthEachPose(motion)) {
      for (std::uint32_t k = motion.interval->first; k <= motion.interval->last; ++k) {
        PathInterval one;
        compare(slot, points, node, lane, voxel_frame_.motionAt(k, one), candidates, bound);
      }
      return (all & ~results_.settled[slot]) != 0;
    }
    LeafVisit leaf;
    leaf.points = points;
    leaf.slot = slot;
    leaf.open = all & ~results_.settled[slot];
    leaf.begin(voxel_frame_, motion, bound);
    for (std::uint32_t i = 0; query_.closest && i < points.count; ++i)
      if (results_.bestBounds(points.begin + i, motion.interval->first))
        leaf.lowerReach(voxel_frame_, i, results_.best[points.begin + i].reach, motion);
    ++results_.work.volumes_carried;
    at_pose_.beginVisit(motion);
    records_.beginVisit();
    compared_.clear();
    if (motion.at_rest && query_.everything())
      nearestFirst(candidates, points, motion);
    else
      model_.near(leaf.around, candidates, motion.steps, near_);
    for (const Siblings& candidate : near_) {
      push(leaf, candidate, leaf.open, motion);
      while (!stack_.empty() && leaf.open != 0 && !stop_check_.isOver()) {
        pulse_.look();
        const PointsNearBoxes next = stack_.back();
        stack_.pop_back();
        if (motion.at_rest)
          compareBox(leaf, next.boxes, motion);
        else
          compareBoxes(leaf, next, motion);
      }
      if (leaf.open == 0) break;
    }
    stack_.clear();
    on_arcs_.finish(leaf, motion);
    if (query_.request.pose_summaries) at_pose_.countPoses(leaf, motion, node.points(lane));
    settle(leaf);
    return (all & ~results_.settled[slot]) != 0;
  }

  /// Whether poses may be taken one by one: few of them.
  bool isWorthEachPose(const VoxelMotion& motion) const
  {
    const std::uint32_t steps = motion.interval->last - motion.interval->first;
    return !query_.path.is_swept && steps > 0 && static_cast<float>(steps) <= kFewPoses;
  }

  /// Whether there is a plane beside the model. Nothing strays across it at single poses.
  bool hasPlane() const { return records_.hasPlane(); }

  /// Bits of a node's children of which no record matters during a motion, as a plane beside the model shows.
  std::uint32_t besideOf(const Node& node, std::uint32_t lanes, const VoxelMotion& motion)
  {
    if (HWY_LIKELY(!hasPlane())) return 0;
    std::uint32_t beside = 0;
    for (const std::uint32_t lane : Bits(lanes))
      if (records_.areBeside(node.begin[lane], node.begin[lane + 1], motion)) beside |= 1u << lane;
    return beside;
  }

  /// Returns the reach of pairs of points with uncertainties of their own.
  const UncertainReach& reach() const { return at_pose_.reach(); }

private:
  /// After a leaf was compared during a motion: notes the points whose answers no later motion changes.
  void settle(const LeafVisit& leaf)
  {
    std::uint32_t settled = results_.hit[leaf.slot];
    if (query_.request.pose_summaries) return;
    for (const std::uint32_t i : Bits(query_.closest ? settled : 0))
      if (!results_.best[leaf.points.begin + i].meets) settled &= ~(1u << i);
    results_.settled[leaf.slot] = static_cast<std::uint16_t>(settled);
  }

  /// The candidates by their distance from the leaf, at one pose: the sooner its points' bounds are small, the fewer
  /// boxes are opened.
  void nearestFirst(const std::vector<Siblings>& candidates, const LeafRange& points, const VoxelMotion& motion)
  {
    const std::uint32_t i = points.count / 2;
    const Point at = carryPoint(motion.from.m, motion.from.g, {points.x()[i], points.y()[i], points.z()[i]});
    by_distance_.sort(candidates, at, near_);
  }

  /// Boxes of the model, and bits of the points of the leaf that may meet them.
  struct PointsNearBoxes {
    Siblings boxes;
    std::uint32_t points;
  };

  /// At one pose boxes are compared one after another: what is found in one may bound the search before the next.
  void push(const LeafVisit& leaf, const Siblings& boxes, std::uint32_t points, const VoxelMotion& motion)
  {
    if (!motion.at_rest) return stack_.push_back({boxes, points});
    for (const std::uint32_t lane : Bits(boxes.lanes)) stack_.push_back({boxes.only(1u << lane), leaf.open});
  }

  /// All points at one pose against a box: opens it, or compares its points.
  void compareBox(LeafVisit& leaf, const Siblings& boxes, const VoxelMotion& motion)
  {
    const ModelBox box = boxes[static_cast<std::uint32_t>(std::countr_zero(boxes.lanes))];
    results_.work.node_pairs += static_cast<std::uint64_t>(std::popcount(leaf.open));
    const auto& at = leaf.segments.start;
    std::uint32_t points = leaf.open & leaf.nearBox(at[0], at[1], at[2], box);
    if (!query_.of_points) points = records_.mayMeet(leaf, points, box, motion);
    if (points == 0) return;
    if (box.isLeaf() && !query_.of_points)
      records_.compare(leaf, rangesAt(points, motion), box, motion);
    else if (box.isLeaf())
      at_pose_.compare(leaf, points, box, motion.interval->first, motion);
    else if (model_.isBlunt(box, motion))
      at_pose_.meetInDoubles(leaf, points, box, motion.interval->first, motion);
    else if (model_.mayOpen(box))
      push(leaf, model_.near(leaf.around, model_.below(box), motion.steps), leaf.open, motion);
    else
      leaveUndecided(leaf, points);
  }

  /// Points against boxes, during the motion: each point against all boxes at once, or each box against all points.
  HWY_INLINE void compareBoxes(LeafVisit& leaf, const PointsNearBoxes& candidate, const VoxelMotion& motion)
  {
    const BoxNode& node = candidate.boxes.box();
    const std::uint32_t points = candidate.points & leaf.open, boxes = candidate.boxes.lanes;
    results_.work.node_pairs += static_cast<std::uint64_t>(std::popcount(points) * std::popcount(boxes));
    ClippedSegments<kLeafPoints> clipped;
    if (kLeafPoints / kLanes * static_cast<std::size_t>(std::popcount(boxes)) <
        static_cast<std::size_t>(std::popcount(points))) {
      for (const std::uint32_t lane : Bits(boxes)) {
        const ModelBox box = candidate.boxes[lane];
        const BoxEnds ends(box);
        meet(leaf, points & segmentsInBox(leaf.segments, ends.low, ends.high, motion.steps, &clipped), clipped, box,
             motion);
      }
      return;
    }
    std::uint32_t near[kLanes] = {}, met = 0;
    for (const std::uint32_t i : Bits(points)) {
      const std::uint32_t its = boxes & boxesOnArc(leaf.segments, i, node.low, node.high, motion.steps, clips_[i]);
      met |= its;
      for (const std::uint32_t k : Bits(its)) near[k] |= 1u << i;
    }
    for (const std::uint32_t k : Bits(met)) {
      const bool ends_here = node.isLeaf(k) || model_.isBlunt(candidate.boxes[k], motion);
      for (const std::uint32_t i : Bits(ends_here ? near[k] : 0)) {
        clipped.from[i] = clips_[i].from[k];
        clipped.to[i] = clips_[i].to[k];
      }
      meet(leaf, near[k], clipped, candidate.boxes[k], motion);
    }
  }

  /// Opens a box that points in `lanes` may meet, or compares them with its points.
  HWY_INLINE void meet(LeafVisit& leaf, std::uint32_t lanes, ClippedSegments<kLeafPoints>& clipped, const ModelBox& box,
                       const VoxelMotion& motion)
  {
    lanes &= leaf.open;
    if (!query_.of_points) lanes = records_.mayMeet(leaf, lanes, box, motion);
    if (lanes == 0) return;
    if (!box.isLeaf()) {
      if (!model_.mayOpen(box)) return leaveUndecided(leaf, lanes);
      if (model_.isBlunt(box, motion)) return eachPose(leaf, rangesOf(lanes, clipped, motion), box, motion);
      return push(leaf, model_.below(box), lanes, motion);
    }
    if (query_.path.is_swept)
      swept_.compare(leaf, lanes, clipped, box, motion);
    else
      comparePoses(leaf, lanes, clipped, box, motion);
  }

  void leaveUndecided(const LeafVisit& leaf, std::uint32_t points)
  {
    results_.undecided[leaf.slot] = static_cast<std::uint16_t>(results_.undecided[leaf.slot] | points);
  }

  /// Two leaves, at each pose that brings them near.
  HWY_INLINE void comparePoses(LeafVisit& leaf, std::uint32_t lanes, ClippedSegments<kLeafPoints>& clipped,
                               const ModelBox& box, const VoxelMotion& motion)
  {
    if (!query_.of_points) return records_.compare(leaf, rangesOf(lanes, clipped, motion), box, motion);
    const PoseRanges ranges = rangesOf(lanes, clipped, motion);
    if (on_arcs_.areFor(motion) && query_.boxes.unit(box.voxel) == 1.0)
      return on_arcs_.compare(leaf, ranges, box, motion);
    eachPose(leaf, ranges, box, motion);
  }

  /// Points against a box, at each pose that brings them near.
  HWY_INLINE void eachPose(LeafVisit& leaf, const PoseRanges& ranges, const ModelBox& box, const VoxelMotion& motion)
  {
    for (std::uint32_t k = ranges.begin; k < ranges.end && (ranges.lanes & leaf.open) != 0 && !stop_check_.isOver();
         ++k) {
      pulse_.step();
      std::uint32_t here = ranges.at(k, leaf.open);
      if (query_.first && !query_.everything())
        for (const std::uint32_t i : Bits(here))
          if (results_.first[leaf.points.begin + i] <= k) here &= ~(1u << i);
      if (here == 0) continue;
      if (box.isLeaf())
        at_pose_.compare(leaf, here, box, k, motion);
      else
        at_pose_.meetInDoubles(leaf, here, box, k, motion);
    }
  }

  const TrajectoryQuery& query_;
  const VoxelInModelFrame& voxel_frame_;
  ModelBoxes& model_;
  StopCheck& stop_check_;
  WorkPulse& pulse_;
  VoxelResults& results_;
  ComparedPairs compared_;
  SweptLeaf swept_;
  LeafAtPose at_pose_;
  ArcsAtPoses on_arcs_;
  RecordLeaf records_;
  std::vector<Siblings> near_; // boxes that the leaf may meet
  std::vector<PointsNearBoxes> stack_;
  ClippedSegments<kLanes> clips_[kLeafPoints]; // of each point, when it is in the boxes it is compared with
  BoxesByDistance by_distance_;
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
