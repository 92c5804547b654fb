// SPDX-License-Identifier: BSD-3-Clause
// A leaf of the scan against leaves of the model at single poses: by float bands, and exactly within the bands.

#if defined(PCL_BSH_TRAJECTORY_LEAF_LEAF_AT_POSE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAJECTORY_LEAF_LEAF_AT_POSE_INL_H_
#undef PCL_BSH_TRAJECTORY_LEAF_LEAF_AT_POSE_INL_H_
#else
#define PCL_BSH_TRAJECTORY_LEAF_LEAF_AT_POSE_INL_H_
#endif

#include <pcl_bsh/trajectory/boxes/model_boxes-inl.h>
#include <pcl_bsh/trajectory/leaf/leaf_visit-inl.h>
#include <pcl_bsh/trajectory/model_descent.h>
#include <pcl_bsh/trajectory/voxel_results.h>
#include <pcl_bsh/traversal/uncertain_points-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

class LeafAtPose {
public:
  LeafAtPose(const TrajectoryQuery& query, const VoxelInModelFrame& voxel_frame, VoxelResults& results)
  : query_(query),
    voxel_frame_(voxel_frame),
    results_(results),
    reach_(voxel_frame.error, query.path.skew, 1.0, query.of_pairs.leastInCommon(), query.of_pairs.mostInCommon(),
           query.model.storage().uncertainty.most, 0.0f)
  {
  }

  /// Before a leaf is compared during a motion.
  void beginVisit(const VoxelMotion& motion)
  {
    met_.clear();
    if (query_.request.pose_summaries)
      pose_hits_.assign(motion.interval->last - motion.interval->first + 1 + kLanes, 0);
  }

  /// Where summaries are asked for, per pose of the motion: the points that are known to collide. Readable for whole
  /// vectors.
  std::uint16_t* hits() { return pose_hits_.data(); }

  /// Returns the reach of pairs of points with uncertainties of their own.
  const UncertainReach& reach() const { return reach_; }

  /// Two leaves of points at pose k: by float bands, and exactly within the bands.
  void compare(LeafVisit& leaf, std::uint32_t lanes, const ModelBox& box, std::uint32_t k, const VoxelMotion& motion)
  {
    if (!met_.empty() && (lanes &= ~metBefore(box.voxel, k, motion)) == 0) return;
    if (!motion.at_rest) lanes &= nearBoxAt(leaf, box, k);
    if (lanes == 0) return;
    ++results_.work.leaf_pairs;
    const BoxLeaf other = box.points(query_.boxes);
    const double unit = query_.boxes.unit(box.voxel);
    const AffineMap map = voxel_frame_.mapAt(query_.path.poses[k], query_.boxes.offset(box.voxel), unit);
    bool in_floats = unit == 1.0 && voxel_frame_.frame.unit == 1.0;
    for (const float g : map.g) in_floats = in_floats && std::abs(g) <= voxel_frame_.far;
    LeafPoints points;
    carry(map.m, map.g, leaf.points.x(), leaf.points.y(), leaf.points.z(), leaf.points.count, points.x, points.y,
          points.z);
    alignas(64) float nearest[kLeafPoints];
    std::fill(std::begin(nearest), std::end(nearest), std::numeric_limits<float>::infinity());
    std::uint32_t hit = 0;
    if (in_floats) {
      std::uint32_t undecided = 0;
      if (query_.nearestDecides() || query_.everything())
        nearestSquared(points, other.x(), other.y(), other.z(), firstBits(other.count), nearest);
      if (query_.nearestDecides()) {
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
      for (const std::uint32_t i : Bits(lanes)) {
        for (std::uint32_t j = 0; j < other.count && (hit >> i & 1) == 0; ++j)
          if (results_.collide({leaf.points.record(i), other.record(j)}, k)) hit |= 1u << i;
      }
    }
    if (hit != 0) note(leaf, hit, points, nearest, in_floats, other, k, motion);
  }

  /// Compares points of the leaf at pose k with the points in a box that is not a leaf, one by one, in double. If the
  /// box is in a voxel of the model, compares them with all points of the voxel.
  HWY_NOINLINE void meetInDoubles(LeafVisit& leaf, std::uint32_t lanes, const ModelBox& box, std::uint32_t k,
                                  const VoxelMotion& motion)
  {
    const bool in_voxel = box.voxel != kAboveVoxels;
    if (in_voxel) {
      if (met_.empty()) met_.resize(motion.interval->last - motion.interval->first + 1);
      const std::uint32_t before = metBefore(box.voxel, k, motion);
      met_[k - motion.interval->first] = {box.voxel, before | lanes};
      lanes &= ~before;
    }
    for (const std::uint32_t i : Bits(lanes)) {
      NearestPoint* const best = query_.closest ? &results_.best[leaf.points.begin + i] : nullptr;
      const PointAtPose point{leaf.points.record(i), k, best, query_.request.pose_summaries};
      const PointMet met = meet(query_, results_, point, box.voxel, box.node, box.lane);
      if (!met.collides) continue;
      noteHits(leaf, 1u << i, k, motion);
      if (!query_.everything() || !query_.nearestDecides()) continue;
      // Boxes hold balls: none is nearer than at 0, however deep these reach into each other.
      const float reach = std::max(0.0f, roundUp(std::nextafter(met.gap, std::numeric_limits<double>::infinity())));
      if (motion.at_rest) leaf.lowerReach(voxel_frame_, i, reach, motion);
      if (point.for_pose) results_.lowerPoseLimit(k, std::numeric_limits<float>::infinity(), reach);
      if (!best) continue;
      best->reach = std::min(best->reach, reach);
      if (results_.bestBounds(leaf.points.begin + i, motion.interval->first))
        leaf.lowerReach(voxel_frame_, i, best->reach, motion);
    }
  }

  /// Adds the number of points that were found to collide to each pose's count. @param points how many the leaf holds;
  /// points that coincide are compared as one
  void countPoses(const LeafVisit& leaf, const VoxelMotion& motion, std::size_t points)
  {
    for (std::size_t i = 0; i < pose_hits_.size(); ++i) {
      const auto hits = static_cast<std::size_t>(std::popcount(pose_hits_[i]));
      if (hits != 0)
        results_.countPose(motion.interval->first + static_cast<std::uint32_t>(i),
                           points > leaf.points.count ? points : hits);
    }
  }

  /// The points in `hit` collide at pose k.
  void noteHits(LeafVisit& leaf, std::uint32_t hit, std::uint32_t k, const VoxelMotion& motion)
  {
    results_.hit[leaf.slot] = static_cast<std::uint16_t>(results_.hit[leaf.slot] | hit);
    if (!query_.everything() && (!query_.first || k == motion.interval->first)) leaf.open &= ~hit;
    if (query_.request.pose_summaries) {
      std::uint16_t& at = pose_hits_[k - motion.interval->first];
      at = static_cast<std::uint16_t>(at | hit);
    }
    for (const std::uint32_t i : Bits(query_.first ? hit : 0)) {
      double& first = results_.first[leaf.points.begin + i];
      first = std::min(first, static_cast<double>(k));
    }
  }

private:
  /// Compares points with uncertainties of their own.
  /// @param hit becomes the bits of points in `lanes` that collide certainly, or possibly, as the query asks
  /// @param undecided becomes the bits of points whose pairs have to be decided one by one
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

  /// Bits of the leaf's points to which something in a box may matter at pose k.
  std::uint32_t nearBoxAt(const LeafVisit& leaf, const ModelBox& box, std::uint32_t k) const
  {
    LeafPoints at;
    const AffineMap map = voxel_frame_.mapAt(query_.path.poses[k], {0, 0, 0}, 1.0);
    carry(map.m, map.g, leaf.points.x(), leaf.points.y(), leaf.points.z(), leaf.points.count, at.x, at.y, at.z);
    return leaf.nearBox(at.x, at.y, at.z, box);
  }

  /// Which of the points met all of a voxel of the model at pose k before, as far as is remembered: its boxes hold
  /// nothing new for them.
  std::uint32_t metBefore(std::uint32_t voxel, std::uint32_t k, const VoxelMotion& motion) const
  {
    const VoxelMet& met = met_[k - motion.interval->first];
    return met.voxel == voxel ? met.points : 0;
  }

  /// Notes the points in `hit`, which collide at pose k, and their nearest pairs.
  /// @param nearest per point, the squared distance of its nearest pair. @param in_floats whether it bounds the
  /// distance
  void note(LeafVisit& leaf, std::uint32_t hit, const LeafPoints& points, const float* nearest, bool in_floats,
            const BoxLeaf& other, std::uint32_t k, const VoxelMotion& motion)
  {
    noteHits(leaf, hit, k, motion);
    if (!query_.everything()) return;
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const bool nearest_decides = query_.nearestDecides();
    for (const std::uint32_t i : Bits(hit)) {
      NearestPoint* best = query_.closest ? &results_.best[leaf.points.begin + i] : nullptr;
      const bool for_point = best && !(in_floats && nearest[i] > best->limit);
      const bool for_pose = query_.request.pose_summaries && !(in_floats && nearest[i] > results_.poseLimit(k));
      if (!for_point && !for_pose && !motion.at_rest) continue;
      float nearest_hit = nearest_decides ? nearest[i] : infinity; // squared distance of a pair that collides
      // Only pairs that may be as near as the nearest that collides are worth an exact look.
      float within = infinity;
      if (in_floats)
        within = nearest_decides ? voxel_frame_.notBeyond(nearest_hit)
                                 : std::max(for_point ? best->limit : 0.0f, for_pose ? results_.poseLimit(k) : 0.0f);
      for (std::uint32_t j = 0; j < other.count && (for_point || for_pose); ++j) {
        const float dx = points.x[i] - other.x()[j], dy = points.y[i] - other.y()[j], dz = points.z[i] - other.z()[j];
        const float squared = (dx * dx + dy * dy) + dz * dz;
        if (in_floats && squared > within) continue;
        const PointPair pair{leaf.points.record(i), other.record(j)};
        if (!nearest_decides) {
          if (!results_.collide(pair, k)) continue;
          nearest_hit = std::min(nearest_hit, squared);
          if (in_floats) within = std::min(within, voxel_frame_.notBeyond(squared));
        }
        if (for_point) results_.consider(*best, pair, k);
        if (for_pose) results_.considerPose(pair, k);
      }
      if (!in_floats || nearest_hit == infinity) continue;
      const float reach = roundUp(voxel_frame_.highOf(nearest_hit));
      // It collides at this pose: what is farther at this pose changes nothing.
      if (motion.at_rest) leaf.lowerReach(voxel_frame_, i, reach, motion);
      if (for_point) {
        best->limit = std::min(best->limit, within);
        best->reach = std::min(best->reach, reach);
        if (results_.bestBounds(leaf.points.begin + i, motion.interval->first))
          leaf.lowerReach(voxel_frame_, i, best->reach, motion);
      }
      if (for_pose) results_.lowerPoseLimit(k, within, reach);
    }
  }

  const TrajectoryQuery& query_;
  const VoxelInModelFrame& voxel_frame_;
  VoxelResults& results_;
  const UncertainReach reach_;
  std::vector<std::uint16_t> pose_hits_; // per pose of a motion: points of a leaf

  /// The voxel of the model that points of the leaf met last in doubles.
  struct VoxelMet {
    std::uint32_t voxel = kNoVoxel;
    std::uint32_t points = 0;
  };
  std::vector<VoxelMet> met_; // per pose of a motion; empty until the first
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
