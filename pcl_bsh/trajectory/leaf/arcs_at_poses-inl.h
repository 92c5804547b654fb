// SPDX-License-Identifier: BSD-3-Clause
// A leaf of the scan on its arcs against leaves of the model, where each pose counts.

#if defined(PCL_BSH_TRAJECTORY_LEAF_ARCS_AT_POSES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAJECTORY_LEAF_ARCS_AT_POSES_INL_H_
#undef PCL_BSH_TRAJECTORY_LEAF_ARCS_AT_POSES_INL_H_
#else
#define PCL_BSH_TRAJECTORY_LEAF_ARCS_AT_POSES_INL_H_
#endif

#include <pcl_bsh/trajectory/leaf/leaf_at_pose-inl.h>
#include <pcl_bsh/trajectory/leaf/leaf_visit-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// Decides many poses of a point at once. A point matters at many poses (with summaries, at each pose at which it
/// collides), mostly near several points of the model. How far a point strays from its arc is bounded. So distances
/// from places on the arc prove that a pair collides, or that it does not. Pairs that they do not decide are compared
/// at the pose itself once all boxes were seen. By then another point of the model has decided most of them, or is
/// nearer. Where very many pairs are at just the clearance, or equally near, the pairs seen so far are compared
/// earlier, so that few are kept.
class ArcsAtPoses {
public:
  ArcsAtPoses(const TrajectoryQuery& query, const VoxelInModelFrame& voxel_frame, VoxelResults& results,
              LeafAtPose& at_pose)
  : query_(query),
    results_(results),
    at_pose_(at_pose),
    voxel_frame_(voxel_frame),
    summing_(query.request.pose_summaries),
    say_something_(query.of_points && voxel_frame.frame.unit == 1.0),
    surely_(std::sqrt(std::max(voxel_frame.band.hit, 0.0f)) * (1.0f - kRadiusMargin))
  {
  }

  /// Whether distances on arcs may decide: not where floats do not hold the squares, nor of more poses than floats
  /// count.
  bool areFor(const VoxelMotion& motion) const
  {
    return say_something_ && motion.squares && motion.steps <= kMostSteps;
  }

  /// Compares points with a model's leaf whose frame has the clouds' unit.
  /// @param ranges the poses at which points may be near it
  void compare(LeafVisit& leaf, const PoseRanges& ranges, const ModelBox& box, const VoxelMotion& motion)
  {
    if (ranges.lanes == 0) return;
    if (!is_begun_) begin(motion);
    const BoxLeaf other = box.points(query_.boxes);
    const std::array<float, 3> shift = query_.boxes.shift(box.voxel);
    const BoxEnds ends(box);
    const LaneTag d;
    const auto at_once = static_cast<std::uint32_t>(hn::Lanes(d));
    for (const std::uint32_t i : Bits(ranges.lanes)) {
      std::uint32_t end = ranges.last[i] - motion.interval->first + 1;
      if (!query_.everything())
        end = static_cast<std::uint32_t>(std::clamp(knownFrom(leaf, i), 0.0f, static_cast<float>(end)));
      for (std::uint32_t k = ranges.first[i] - motion.interval->first; k < end; k += at_once) {
        const PlacesOnArc at(leaf.segments, i, k, motion.steps);
        const LaneVector limits = limitsAt(leaf, i, k);
        const auto asked = hn::And(hn::FirstN(d, end - k), hn::Le(at.squaredDistance(ends.low, ends.high), limits));
        if (hn::AllFalse(d, asked)) continue;
        const LaneVector nearest = at.nearestSquared(other.x(), other.y(), other.z(), other.count, shift.data());
        std::uint32_t near = bitsOf(d, hn::And(asked, hn::Le(nearest, limits)));
        if (near == 0) continue;
        hn::Store(nearest, d, nearest_);
        for (const std::uint32_t lane : Bits(near)) note(leaf, i, k + lane, nearest_[lane], box, motion);
      }
    }
  }

  /// After the last box: compares the remaining pairs at the poses.
  void finish(LeafVisit& leaf, const VoxelMotion& motion)
  {
    is_begun_ = false;
    compareCandidates(leaf, motion);
  }

private:
  static constexpr float kMostSteps = 0x1p22f;
  static constexpr std::size_t kMostCandidates = std::size_t{1} << 14;

  /// A point and a leaf of the model at a step after the motion's first pose, and their squared distance on the arc.
  struct Candidate {
    ModelBox box;
    std::uint32_t point, step;
    float squared;
  };

  void begin(const VoxelMotion& motion)
  {
    is_begun_ = true;
    first_pose_ = motion.interval->first;
    astray_ = motion.reach + motion.rounding - static_cast<float>(query_.reach);
    miss_ = squareOver(motion.reach + motion.rounding);
    const float sure = surely_ - static_cast<float>(motion.stray) - 2 * motion.rounding;
    sure_ = sure > 0.0f ? sure * sure * (1.0f - kRadiusMargin) : -1.0f;
    if (!summing_) return;
    const std::uint32_t poses = motion.interval->last - motion.interval->first + 1;
    limits_.resize(poses + kLanes);
    for (std::uint32_t k = 0; k < poses; ++k) limits_[k] = limitOf(results_.poseReach(motion.interval->first + k));
  }

  HWY_NOINLINE void compareCandidates(LeafVisit& leaf, const VoxelMotion& motion)
  {
    // The nearest first: they bound the search, and pairs beyond the bound are not compared.
    std::sort(candidates_.begin(), candidates_.end(),
              [](const Candidate& a, const Candidate& b) { return a.squared < b.squared; });
    for (const Candidate& candidate : candidates_) {
      const std::uint32_t i = candidate.point, k = candidate.step;
      if (isHit(leaf, i, k) && candidate.squared > limitAt(leaf, i, k)) continue;
      const std::uint32_t pose = motion.interval->first + k;
      at_pose_.compare(leaf, 1u << i, candidate.box, pose, motion);
      if (summing_) limits_[k] = std::min(limits_[k], limitOf(results_.poseReach(pose)));
    }
    candidates_.clear();
  }

  /// Returns the step from which on only pairs nearer than the nearest so far matter to a point. @pre no summaries
  float knownFrom(const LeafVisit& leaf, std::uint32_t i) const
  {
    if ((results_.hit[leaf.slot] >> i & 1) == 0) return std::numeric_limits<float>::infinity();
    return query_.first ? static_cast<float>(results_.first[leaf.points.begin + i] - first_pose_) : 0.0f;
  }

  /// Whether a collision of a point at a step is known, or changes no answer.
  bool isHit(const LeafVisit& leaf, std::uint32_t i, std::uint32_t k) const
  {
    if (!summing_) return static_cast<float>(k) >= knownFrom(leaf, i);
    return (at_pose_.hits()[k] >> i & 1) != 0;
  }

  /// A larger squared distance on the arc of a point that is hit changes nothing.
  float limitAt(const LeafVisit& leaf, std::uint32_t i, std::uint32_t k) const
  {
    return summing_ ? std::max(limits_[k], bestLimit(leaf, i)) : bestLimit(leaf, i);
  }

  static float squareOver(float length) { return length * length * (1.0f + kRadiusMargin); }

  /// A larger squared distance on the arc is farther than `reach`.
  float limitOf(float reach) const { return std::min(squareOver(reach + astray_), miss_); }

  /// Returns the limit by the nearest pair that is known of a point.
  float bestLimit(const LeafVisit& leaf, std::uint32_t i) const
  {
    return query_.closest ? limitOf(results_.best[leaf.points.begin + i].reach) : -1.0f;
  }

  /// Returns limits from step k on: larger squared distances change no answer. Where a point is known to collide at a
  /// pose, a pair matters only if it is as near as the nearest so far of the point or of the pose.
  LaneVector limitsAt(const LeafVisit& leaf, std::uint32_t i, std::uint32_t k) const
  {
    const LaneTag d;
    const LaneVector best = hn::Set(d, bestLimit(leaf, i));
    if (!summing_) {
      const LaneVector steps = hn::Iota(d, static_cast<float>(k));
      return hn::IfThenElse(hn::Ge(steps, hn::Set(d, knownFrom(leaf, i))), best, hn::Set(d, miss_));
    }
    const hn::RebindToUnsigned<LaneTag> counts;
    const hn::Rebind<std::uint16_t, LaneTag> halves;
    const auto hits = hn::PromoteTo(counts, hn::LoadU(halves, at_pose_.hits() + k));
    const auto is_hit = hn::RebindMask(d, hn::TestBit(hits, hn::Set(counts, 1u << i)));
    const LaneVector nearer = hn::Max(hn::LoadU(d, limits_.data() + k), best);
    return hn::IfThenElse(is_hit, nearer, hn::Set(d, miss_));
  }

  /// Notes what a squared distance on point i's arc at a step decides, and keeps the pair if it has to be compared
  /// there.
  void note(LeafVisit& leaf, std::uint32_t i, std::uint32_t k, float squared, const ModelBox& box,
            const VoxelMotion& motion)
  {
    const std::uint32_t pose = motion.interval->first + k;
    if (!isHit(leaf, i, k) && squared <= sure_) at_pose_.noteHits(leaf, 1u << i, pose, motion);
    const bool hit = isHit(leaf, i, k);
    if (hit && squared > limitAt(leaf, i, k)) return;
    if (candidates_.size() == kMostCandidates) compareCandidates(leaf, motion);
    candidates_.push_back({box, i, k, squared});
    if (!hit) return;
    if (squared > sure_ && !query_.nearestDecides()) return; // it may not collide, and bounds nothing
    const float high =
        roundUp((std::sqrt(static_cast<double>(squared)) * (1.0 + kRadiusMargin) + astray_) * (1.0 + query_.path.skew));
    if (summing_) {
      results_.lowerPoseLimit(pose, std::numeric_limits<float>::infinity(), high);
      limits_[k] = std::min(limits_[k], limitOf(high));
    }
    if (!query_.closest) return;
    float& reach = results_.best[leaf.points.begin + i].reach;
    reach = std::min(reach, high);
    if (results_.bestBounds(leaf.points.begin + i, first_pose_)) leaf.lowerReach(voxel_frame_, i, reach, motion);
  }

  const TrajectoryQuery& query_;
  VoxelResults& results_;
  LeafAtPose& at_pose_;
  const VoxelInModelFrame& voxel_frame_;
  const bool summing_, say_something_;
  const float surely_; // pairs nearer than this, in floats at a pose, collide
  bool is_begun_ = false;
  std::uint32_t first_pose_ = 0; // of the motion
  float astray_ = 0.0f;          // how much farther two points may be from each other on the arc than at the pose
  float miss_ = 0.0f;            // a larger squared distance on the arc: they do not collide
  float sure_ = 0.0f;            // a squared distance on the arc of at most this: they collide
  std::vector<float> limits_;    // per step: limitOf() the pose
  std::vector<Candidate> candidates_;
  alignas(64) float nearest_[kLanes];
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
