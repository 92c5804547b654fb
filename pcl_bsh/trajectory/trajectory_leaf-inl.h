// SPDX-License-Identifier: BSD-3-Clause
// A leaf of the scan against leaves of the model: at which poses, or instants, their points collide.

#if defined(PCL_BSH_TRAJECTORY_TRAJECTORY_LEAF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAJECTORY_TRAJECTORY_LEAF_INL_H_
#undef PCL_BSH_TRAJECTORY_TRAJECTORY_LEAF_INL_H_
#else
#define PCL_BSH_TRAJECTORY_TRAJECTORY_LEAF_INL_H_
#endif

#include <pcl_bsh/trajectory/leaf_visit-inl.h>
#include <pcl_bsh/trajectory/model_boxes-inl.h>
#include <pcl_bsh/trajectory/pose_ranges-inl.h>
#include <pcl_bsh/trajectory/swept_leaf-inl.h>
#include <pcl_bsh/trajectory/voxel_results.h>
#include <pcl_bsh/traversal/uncertain_points-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

inline constexpr double kLeafStray = 0.01; ///< of a leaf's radius: an interval that strays farther is divided
inline constexpr float kFewPoses = 4;      ///< as quickly looked at one by one as all together

/// Compares leaves of the scan with what they may meet of the model.
class LeafWalk {
public:
  LeafWalk(const TrajectoryQuery& query, const VoxelInModelFrame& voxel_frame, ModelBoxes& model, StopCheck& stop_check,
           VoxelResults& results)
  : query_(query),
    path_(query.path),
    tree_(query.boxes),
    voxel_frame_(voxel_frame),
    model_(model),
    stop_check_(stop_check),
    results_(results),
    swept_(query, voxel_frame, results),
    reach_(voxel_frame.error, query.path.skew, 1.0, query.of_pairs.leastInCommon(), query.of_pairs.mostInCommon(),
           query.model.storage().uncertainty.most, 0.0f)
  {
  }

  /// @param bound no less than the smallest distance of any of the points, where `motion` is one pose
  /// @return whether any of the leaf's points is not settled.
  bool compare(std::size_t slot, const LeafRange& points, const Node& node, std::uint32_t lane,
               const VoxelMotion& motion, const std::vector<Siblings>& candidates, float bound)
  {
    const std::uint32_t all = firstBits(points.count);
    if ((all & ~results_.settled[slot]) == 0 || results_.witness) return false;
    const double limit = path_.is_swept ? path_.stray : kLeafStray * node.r[lane] * voxel_frame_.frame.unit;
    if (motion.interval->divided() && (path_.is_swept ? motion.line_stray : motion.stray) > limit) {
      return compare(slot, points, node, lane, voxel_frame_.motionOf(motion.interval->left), candidates, bound) &&
             compare(slot, points, node, lane, voxel_frame_.motionOf(motion.interval->right), candidates, bound);
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
    if (query_.request.pose_summaries) pose_hits_.assign(motion.interval->last - motion.interval->first + 1, 0);

    places_.beginVisit();
    if (motion.at_rest && query_.everything())
      nearestFirst(candidates, points, motion);
    else
      model_.near(leaf.around, candidates, motion.steps, near_);
    for (const Siblings& candidate : near_) {
      push(leaf, candidate, leaf.open, motion);
      while (!stack_.empty() && leaf.open != 0 && !stop_check_.isOver()) {
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
    if (query_.request.pose_summaries) countPoses(leaf, motion, node.points(lane));
    if (!query_.everything()) results_.settled[slot] = results_.hit[slot];
    return (all & ~results_.settled[slot]) != 0;
  }

  /// Of pairs of points with uncertainties of their own.
  const UncertainReach& reach() const { return reach_; }

private:
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
    for (std::uint32_t bits = boxes.lanes; bits != 0; bits &= bits - 1)
      stack_.push_back({boxes.only(bits & (~bits + 1)), leaf.open});
  }

  /// All points at one pose against a box: opens it, or compares its points.
  void compareBox(LeafVisit& leaf, const Siblings& boxes, const VoxelMotion& motion)
  {
    const ModelBox box = boxes[static_cast<std::uint32_t>(std::countr_zero(boxes.lanes))];
    const BoxEnds ends(box);
    results_.work.node_pairs += static_cast<std::uint64_t>(std::popcount(leaf.open));
    const LeafPoints& at = places_.at(voxel_frame_, leaf.points, motion, motion.interval->first);
    const std::uint32_t points =
        leaf.open & pointsNearBox(at.x, at.y, at.z, kLeafPoints, ends.low, ends.high, leaf.near_squared);
    if (points == 0) return;
    if (box.isLeaf())
      compareAt(leaf, points, box, motion.interval->first, motion);
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
      for (std::uint32_t bits = boxes; bits != 0; bits &= bits - 1) {
        const ModelBox box = candidate.boxes[static_cast<std::uint32_t>(std::countr_zero(bits))];
        const BoxEnds ends(box);
        meet(leaf, points & segmentsInBox(leaf.segments, ends.low, ends.high, motion.steps, &clipped), clipped, box,
             motion);
      }
      return;
    }
    std::uint32_t near[kLanes] = {}, met = 0;
    for (std::uint32_t bits = points; bits != 0; bits &= bits - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(bits));
      const std::uint32_t its = boxes & boxesOnArc(leaf.segments, i, node.low, node.high, motion.steps, clips_[i]);
      met |= its;
      for (std::uint32_t left = its; left != 0; left &= left - 1) near[std::countr_zero(left)] |= 1u << i;
    }
    for (; met != 0; met &= met - 1) {
      const auto k = static_cast<std::uint32_t>(std::countr_zero(met));
      for (std::uint32_t bits = node.isLeaf(k) ? near[k] : 0; bits != 0; bits &= bits - 1) {
        const auto i = static_cast<std::uint32_t>(std::countr_zero(bits));
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
    if (lanes == 0) return;
    if (!box.isLeaf()) {
      if (!model_.mayOpen(box)) return leaveUndecided(leaf, lanes);
      return push(leaf, model_.below(box), lanes, motion);
    }
    if (path_.is_swept)
      sweepPast(leaf, lanes, clipped, box, motion);
    else
      comparePoses(leaf, lanes, clipped, box, motion);
  }

  void leaveUndecided(const LeafVisit& leaf, std::uint32_t points)
  {
    results_.undecided[leaf.slot] = static_cast<std::uint16_t>(results_.undecided[leaf.slot] | points);
  }

  BoxLeaf pointsIn(const ModelBox& leaf) const { return tree_.leaf(leaf.voxel, leaf.box().leaf(leaf.lane)); }

  /// Two leaves, at each pose that brings them near.
  HWY_INLINE void comparePoses(LeafVisit& leaf, std::uint32_t lanes, ClippedSegments<kLeafPoints>& clipped,
                               const ModelBox& box, const VoxelMotion& motion)
  {
    const bool narrows = motion.squares && tree_.unit(box.voxel) == 1.0;
    std::uint32_t near_points[kLeafPoints];
    if (narrows) lanes = nearPoints(leaf, lanes, box, motion, clipped, near_points);
    const PoseRanges ranges = rangesOf(lanes, clipped, motion);
    if ((lanes = ranges.lanes) == 0) return;
    if (narrows && !query_.everything() && !query_.first) {
      // Any pose will do: the one in the middle is nearest.
      for (std::uint32_t bits = lanes; bits != 0; bits &= bits - 1) {
        const auto i = static_cast<std::uint32_t>(std::countr_zero(bits));
        if ((leaf.open >> i & 1) == 0) continue;
        const std::uint32_t k = ranges.first[i] + (ranges.last[i] - ranges.first[i]) / 2;
        compareAt(leaf, ranges.at(k, lanes & leaf.open), box, k, motion);
      }
    }
    for (std::uint32_t k = ranges.begin; k < ranges.end && (lanes & leaf.open) != 0 && !stop_check_.isOver(); ++k) {
      std::uint32_t here = ranges.at(k, lanes & leaf.open);
      if (query_.first && !query_.everything())
        for (std::uint32_t bits = here; bits != 0; bits &= bits - 1) {
          const auto i = static_cast<std::uint32_t>(std::countr_zero(bits));
          if (results_.first[leaf.points.begin + i] <= k) here &= ~(1u << i);
        }
      if (here != 0) compareAt(leaf, here, box, k, motion);
    }
  }

  /// Two leaves, at all instants.
  void sweepPast(LeafVisit& leaf, std::uint32_t lanes, ClippedSegments<kLeafPoints>& clipped, const ModelBox& box,
                 const VoxelMotion& motion)
  {
    const BoxLeaf other = pointsIn(box);
    std::uint32_t near_points[kLeafPoints];
    if (motion.squares && tree_.unit(box.voxel) == 1.0)
      lanes = nearPoints(leaf, lanes, box, motion, clipped, near_points);
    else
      std::fill(std::begin(near_points), std::end(near_points), firstBits(other.count));
    if (lanes != 0) swept_.compare(leaf, lanes, clipped, other, near_points, motion);
  }

  /// Bits of the leaf's points whose segments come near to points of the model's leaf, and when.
  /// @param near_points becomes which points of the model's leaf these are, as bits
  std::uint32_t nearPoints(const LeafVisit& leaf, std::uint32_t lanes, const ModelBox& box, const VoxelMotion& motion,
                           ClippedSegments<kLeafPoints>& clipped, std::uint32_t (&near_points)[kLeafPoints]) const
  {
    const BoxLeaf other = pointsIn(box);
    const Point3 at = tree_.offset(box.voxel);
    const float shift[3] = {static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2])};
    return segmentsNearPoints(leaf.segments, lanes, other.x(), other.y(), other.z(), other.count, shift, motion.steps,
                              motion.smallest, motion.rounding, clipped, near_points);
  }

  /// Two leaves at pose k: by float bands, and exactly within the bands.
  void compareAt(LeafVisit& leaf, std::uint32_t lanes, const ModelBox& box, std::uint32_t k, const VoxelMotion& motion)
  {
    const LeafPoints& at = places_.at(voxel_frame_, leaf.points, motion, k);
    const BoxEnds ends(box);
    alignas(64) float near_squared[kLeafPoints];
    std::copy(leaf.near_squared, leaf.near_squared + kLeafPoints, near_squared);
    if (query_.request.pose_summaries) boundAtPose(leaf, lanes, k, motion, near_squared);
    lanes &= pointsNearBox(at.x, at.y, at.z, kLeafPoints, ends.low, ends.high, near_squared);
    if (lanes == 0) return;
    ++results_.work.leaf_pairs;
    const BoxLeaf other = pointsIn(box);
    const double unit = tree_.unit(box.voxel);
    const AffineMap map = voxel_frame_.mapAt(path_.poses[k], tree_.offset(box.voxel), unit);
    bool certain = (query_.everything() ? query_.nearestDecides() : query_.radii == 0.0) && unit == 1.0 &&
                   voxel_frame_.frame.unit == 1.0;
    for (const float g : map.g) certain = certain && std::abs(g) <= voxel_frame_.far;
    LeafPoints points;
    carry(map.m, map.g, leaf.points.x(), leaf.points.y(), leaf.points.z(), leaf.points.count, points.x, points.y,
          points.z);
    alignas(64) float nearest[kLeafPoints];
    std::fill(std::begin(nearest), std::end(nearest), std::numeric_limits<float>::infinity());
    std::uint32_t hit = 0;
    if (certain) {
      std::uint32_t undecided = 0;
      if (query_.of_pairs.isOne()) {
        nearestSquared(points, other.x(), other.y(), other.z(), firstBits(other.count), nearest);
        hit = lanes & atMost(nearest, voxel_frame_.band.hit);
        undecided = lanes & ~hit & ~above(nearest, voxel_frame_.band.miss);
      }
      else {
        compareUncertain(leaf, lanes, points, other, hit, undecided);
      }
      if (undecided != 0)
        eachPairNotBeyond(points, undecided, other, voxel_frame_.band.miss,
                          [&](std::uint32_t i, std::uint32_t j, float) {
                            if ((hit >> i & 1) == 0 && results_.collide({leaf.points.record(i), other.record(j)}, k))
                              hit |= 1u << i;
                            return (undecided & ~hit) == 0;
                          });
    }
    else {
      for (std::uint32_t bits = lanes; bits != 0; bits &= bits - 1) {
        const auto i = static_cast<std::uint32_t>(std::countr_zero(bits));
        for (std::uint32_t j = 0; j < other.count && (hit >> i & 1) == 0; ++j)
          if (results_.collide({leaf.points.record(i), other.record(j)}, k)) hit |= 1u << i;
      }
    }
    if (hit != 0) note(leaf, hit, points, nearest, certain, other, k, motion);
  }

  /// Points with uncertainties of their own, as the query asks about them. @param hit, undecided become those in
  /// `lanes` that collide for certain, and those of which single pairs have to be asked
  HWY_NOINLINE void compareUncertain(const LeafVisit& leaf, std::uint32_t lanes, const LeafPoints& points,
                                     const BoxLeaf& other, std::uint32_t& hit, std::uint32_t& undecided) const
  {
    static constexpr float kNone[kLeafPoints] = {};
    const SphereHierarchy::Storage& scan = query_.scan.hierarchy().storage();
    const auto voxel = static_cast<std::size_t>(&voxel_frame_.voxel - scan.voxels.get());
    const UncertainPoints limits(reach_, ownOf(ownUncertainties(scan, voxel), leaf.points));
    alignas(64) float longer[kLeafPoints], shorter[kLeafPoints];
    std::fill(std::begin(longer), std::end(longer), std::numeric_limits<float>::infinity());
    std::fill(std::begin(shorter), std::end(shorter), std::numeric_limits<float>::infinity());
    nearestWithLengths(points, other.x(), other.y(), other.z(), other.lengths ? other.lengths : kNone, reach_.scale_up,
                       firstBits(other.count), longer, shorter);
    hit = lanes & (query_.certain ? atMostEach(longer, limits.sure) : atMostEach(shorter, limits.maybe));
    undecided =
        lanes & ~hit & ~(query_.certain ? aboveEach(longer, limits.sure_miss) : aboveEach(shorter, limits.miss));
  }

  /// A point that is known to collide at pose k matters again only where it may be nearer than the nearest so far, of
  /// itself or of the pose. Nothing is bounded where the nearest pair does not decide: no reach is known there.
  void boundAtPose(LeafVisit& leaf, std::uint32_t lanes, std::uint32_t k, const VoxelMotion& motion,
                   float* near_squared) const
  {
    for (std::uint32_t bits = lanes & pose_hits_[k - motion.interval->first]; bits != 0; bits &= bits - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(bits));
      float best = results_.poseReach(k);
      if (query_.closest) best = std::max(best, results_.best[leaf.points.begin + i].reach);
      if (motion.at_rest) leaf.lowerReach(voxel_frame_, i, best, motion);
      near_squared[i] = std::min(near_squared[i], voxel_frame_.nearSquared(motion, best));
    }
  }

  /// What follows from the points in `hit`, which collide at pose k.
  void note(LeafVisit& leaf, std::uint32_t hit, const LeafPoints& points, const float* nearest, bool certain,
            const BoxLeaf& other, std::uint32_t k, const VoxelMotion& motion)
  {
    results_.hit[leaf.slot] = static_cast<std::uint16_t>(results_.hit[leaf.slot] | hit);
    if (!query_.everything() && (!query_.first || k == motion.interval->first)) leaf.open &= ~hit;
    if (query_.request.pose_summaries) {
      std::uint16_t& at = pose_hits_[k - motion.interval->first];
      at = static_cast<std::uint16_t>(at | hit);
    }
    for (std::uint32_t bits = hit; bits != 0; bits &= bits - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(bits));
      if (query_.first) {
        double& first = results_.first[leaf.points.begin + i];
        first = std::min(first, static_cast<double>(k));
      }
      if (!query_.everything()) continue;
      // It collides at this pose: what is farther at this pose changes nothing.
      if (motion.at_rest && certain) leaf.lowerReach(voxel_frame_, i, roundUp(voxel_frame_.highOf(nearest[i])), motion);
      // Only what may be as near as the nearest in floats is worth an exact look.
      const float within = certain ? voxel_frame_.notBeyond(nearest[i]) : std::numeric_limits<float>::infinity();
      NearestPoint* best = query_.closest ? &results_.best[leaf.points.begin + i] : nullptr;
      const bool for_point = best && !(certain && nearest[i] > best->limit);
      const bool for_pose = query_.request.pose_summaries && !(certain && nearest[i] > results_.poseLimit(k));
      if (!for_point && !for_pose) continue;
      for (std::uint32_t j = 0; j < other.count; ++j) {
        const float dx = points.x[i] - other.x()[j], dy = points.y[i] - other.y()[j], dz = points.z[i] - other.z()[j];
        const float squared = (dx * dx + dy * dy) + dz * dz;
        if (certain && squared > within) continue;
        const PointPair pair{leaf.points.record(i), other.record(j)};
        if (!query_.of_pairs.isOne() && !results_.collide(pair, k)) continue;
        if (for_point) results_.consider(*best, pair, k);
        if (for_pose) results_.considerPose(pair, k);
      }
      if (for_point && certain) {
        const double high = voxel_frame_.highOf(nearest[i]);
        best->limit = std::min(best->limit, voxel_frame_.notBeyond(nearest[i]));
        best->reach = std::min(best->reach, roundUp(high));
        if (results_.bestBounds(leaf.points.begin + i, motion.interval->first))
          leaf.lowerReach(voxel_frame_, i, best->reach, motion);
      }
      if (for_pose && certain)
        results_.lowerPoseLimit(k, voxel_frame_.notBeyond(nearest[i]), roundUp(voxel_frame_.highOf(nearest[i])));
    }
  }

  void countPoses(const LeafVisit& leaf, const VoxelMotion& motion, std::size_t points)
  {
    for (std::size_t i = 0; i < pose_hits_.size(); ++i) {
      const auto hits = static_cast<std::size_t>(std::popcount(pose_hits_[i]));
      if (hits != 0)
        results_.countPose(motion.interval->first + static_cast<std::uint32_t>(i),
                           points > leaf.points.count ? points : hits);
    }
  }

  const TrajectoryQuery& query_;
  const PosePath& path_;
  const BoxTree& tree_;
  const VoxelInModelFrame& voxel_frame_;
  ModelBoxes& model_;
  StopCheck& stop_check_;
  VoxelResults& results_;
  SweptLeaf swept_;
  const UncertainReach reach_;
  std::vector<Siblings> near_; // what the leaf may meet
  std::vector<PointsNearBoxes> stack_;
  ClippedSegments<kLanes> clips_[kLeafPoints]; // of each point, when it is in the boxes it is compared with
  BoxesByDistance by_distance_;
  PlacesAtPoses places_;
  std::vector<std::uint16_t> pose_hits_; // per pose of a motion: points of a leaf
};

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle
