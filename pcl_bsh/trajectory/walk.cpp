// SPDX-License-Identifier: BSD-3-Clause
// The walk along a trajectory. The list of a scan's node holds the boxes of the model that can still matter to it, for
// an interval of poses at once. Seen by the model, the scan's points move nearly on parabolas: a node is a thick arc,
// the model a tree of boxes. The arc is as thick as the node's sphere, and as far as the interval strays from a
// parabola. An interval that strays far for the node's size is halved; else the node is opened.
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/trajectory/query.h>

#include <algorithm>
#include <cmath>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/trajectory/walk.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/trajectory/leaf/leaf-inl.h>
#include <pcl_bsh/trajectory/node_visit-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {
namespace {

constexpr double kNodeStray = 0.03; // of a node's radius: an interval that strays farther is divided
constexpr float kSeedSize = 0.5f;   // of the voxel's radius: larger boxes of the model are opened before its descent
constexpr float kBoxSize = 2.0f;    // of a node's radius: a larger box of the model is opened

/// Memory that one voxel's walk after another uses.
struct WalkScratch {
  Visits<NodeVisit> visits;
  LongTriangles long_triangles;
};

/// Takes one voxel of the scan along the trajectory.
class TrajectoryWalk : public ListVisitor<NodeVisit> {
public:
  TrajectoryWalk(const TrajectoryQuery& query, const StopRule& rule, std::uint32_t voxel, WalkScratch& scratch)
  : query_(query),
    rule_(rule),
    index_(voxel),
    voxel_frame_(query, voxel),
    oriented_boxes_(voxel_frame_),
    results_(query),
    walk_(rule, results_.work.node_pairs, scratch.visits),
    model_(query.boxes, rule, results_.work),
    leaves_(query, voxel_frame_, model_, walk_.stop_check, pulse_, results_, scratch.long_triangles),
    settled_reach_(settledReach()),
    settling_(!query.everything() && !query.first && query.of_points && voxel_frame_.frame.unit == 1.0 &&
              settled_reach_ > 0.0f)
  {
    scratch.long_triangles.forget();
  }

  /// @param near at least one interval
  VoxelResult run(std::span<const NearVoxel> near)
  {
    const std::vector<PathInterval>& intervals = query_.path.intervals;
    if (query_.request.pose_summaries)
      results_.beginPoses(intervals[near.front().interval].first, intervals[near.back().interval].last);
    std::vector<Siblings> candidates;
    for (const auto [voxel, interval] : near) {
      if (walk_.stop_check.isOver() || isDone()) return leave(true);
      pulse_.step();
      const VoxelMotion motion = voxel_frame_.motionOf(interval);
      candidates.clear();
      ++results_.work.volumes_carried;
      model_.collect(voxel_frame_.aroundVoxel(motion), motion, kSeedSize * static_cast<float>(voxel_frame_.radius),
                     model_.root(), candidates);
      if (candidates.empty()) continue;
      if (!voxel_ && !mayEnter()) return leave(true);
      if (!voxel_) enter(motion);
      if (open_lanes_[0] == 0) break;
      walk_.descend(*this, Part{voxel_->nodes[0], 0, motion}, candidates);
    }
    return leave(walk_.stop_check.isOver());
  }

  // As ListWalk asks.

  /// A node of the scan, for an interval of poses.
  struct Part {
    const Node& node;
    std::uint32_t index;
    const VoxelMotion& motion;
  };

  void left(const Part& part, const std::vector<Siblings>&)
  {
    for (std::uint32_t lane = 0; lane < part.node.count; ++lane)
      results_.undecided[part.index * kLanes + lane] =
          static_cast<std::uint16_t>(firstBits(part.node.isLeaf(lane) ? part.node.comparedPoints(lane) : 1));
  }

  /// Halves an interval that strays far for the node's size, or takes its poses one by one.
  template <class Descend>
  bool divides(const Part& part, const Descend& descend)
  {
    pulse_.step();
    const VoxelMotion& motion = part.motion;
    const std::uint8_t& open = open_lanes_[part.index];
    const auto take = [&](const VoxelMotion& smaller) { descend(Part{part.node, part.index, smaller}); };
    float largest = 0.0f;
    for (std::uint32_t lane = 0; lane < part.node.count; ++lane) largest = std::max(largest, part.node.r[lane]);
    if (motion.divides(kNodeStray * largest * voxel_frame_.frame.unit)) {
      for (const std::uint32_t half : {motion.interval->left, motion.interval->right})
        if (open != 0 && !isDone()) take(voxel_frame_.motionOf(half));
      return true;
    }
    if (!isWorthEachPose(motion, largest)) return false;
    for (std::uint32_t k = motion.interval->first; k <= motion.interval->last && open != 0 && !isDone(); ++k) {
      PathInterval one;
      take(voxel_frame_.motionAt(k, one));
    }
    return true;
  }

  std::uint32_t refine(NodeVisit& visit, const Part& part, const std::vector<Siblings>& candidates)
  {
    const auto& [node, index, motion] = part;
    const std::uint32_t beside = leaves_.besideOf(node, open_lanes_[index], motion);
    if ((open_lanes_[index] & ~beside) == 0) return 0;
    visit.begin(node, index, motion, voxel_frame_, oriented_boxes_);
    results_.work.volumes_carried += node.count + std::uint64_t{1}; // the children and what is around them
    model_.near(visit.around, candidates, motion.steps, visit.candidates);
    if (motion.at_rest) boundDistances(visit, index, motion);
    if (settling_) settleByPoints(visit, index, motion);
    for (const Siblings& candidate : visit.candidates) take(visit, candidate, motion, open_lanes_[index] & ~beside);
    return open_lanes_[index] & ~beside;
  }

  bool wants(const NodeVisit&, std::uint32_t) const { return !isDone(); }

  void compare(const Part& part, const NodeVisit& visit, std::uint32_t lane, std::size_t)
  {
    const LeafRange points{voxel_, part.node.begin[lane], part.node.comparedPoints(lane)};
    const bool is_open =
        leaves_.compare(part.index * kLanes + lane, points, part.node, lane, part.motion, visit.near[lane],
                        part.motion.at_rest ? visit.bound[lane] : std::numeric_limits<float>::infinity());
    if (!is_open) close(part.index, lane);
  }

  Part below(const Part& part, const NodeVisit&, std::uint32_t lane) const
  {
    const std::uint32_t index = part.node.child[lane];
    return {voxel_->nodes[index], index, part.motion};
  }

  void settled(const Part& part, std::uint32_t lane)
  {
    if (open_lanes_[part.node.child[lane]] == 0) close(part.index, lane);
  }

private:
  bool mayEnter() const
  {
    return rule_.mayEnter([this] { return query_.scan.hierarchy().storage().pointsToBuild(index_); });
  }

  /// Ends the walk. @param unsure whether something was not looked at
  VoxelResult leave(bool unsure)
  {
    VoxelResult answer;
    if (voxel_ && !rule_.mayStop() && !query_.witness) results_.finish(*voxel_);
    answer.witness = results_.witness;
    if (rule_.mayStop()) answer.undecided = voxel_ ? results_.decide(*voxel_, unsure) : unsure;
    if (rule_.mayStop() && !voxel_ && !unsure)
      query_.scan.hierarchy().storage().forEachRecord(
          index_, [this](std::uint32_t i) { query_.result.flags[i] = Verdict::free; });
    answer.work = results_.work;
    return answer;
  }

  void enter(const VoxelMotion& motion)
  {
    voxel_ = &query_.scan.hierarchy().storage().built(index_, results_.work);
    for (const Node& node : voxel_->nodes) open_lanes_.push_back(static_cast<std::uint8_t>(firstBits(node.count)));
    results_.begin(*voxel_);
    own_ = ownUncertainties(query_.scan.hierarchy().storage(), index_);
    if (query_.witness) return;
    oriented_boxes_.fit(*voxel_, motion.from);
    results_.work.volumes_built += countChildren(voxel_->nodes);
  }

  float settledReach() const
  {
    const UncertainReach& reach = leaves_.reach();
    if (!query_.of_pairs.isOne()) return query_.certain ? reach.sure : reach.maybe;
    return voxel_frame_.band.hit > 0.0f ? std::sqrt(voxel_frame_.band.hit) * (1.0f - kRadiusMargin) : 0.0f;
  }

  /// Returns a probe: a child is settled if a point of the model is in it. Where certain collisions are asked for, the
  /// largest uncertainty of the child's points makes it shorter; else the smallest makes it longer.
  ProbeSphere probeOf(std::uint32_t index, std::uint32_t lane, float radius) const
  {
    const Node& node = voxel_->nodes[index];
    ProbeSphere probe{
        {node.x[lane], node.y[lane], node.z[lane]}, settled_reach_ - radius * (1.0f + 4 * kRadiusMargin), 0};
    if (query_.of_pairs.isOne()) return probe;
    const UncertainReach& reach = leaves_.reach();
    const float least = own_ ? own_->nodes[index].least[lane] * reach.scale_down : 0.0f;
    const float most = own_ ? own_->nodes[index].most[lane] * reach.scale_up : 0.0f;
    probe.reach += (query_.certain ? -most : least) - (radius + most + reach.magnitude) * 2 * kSumMargin;
    probe.scale = query_.certain ? -reach.scale_up * (1.0f + kReachMargin) : reach.scale_down * (1.0f - kReachMargin);
    probe.farther = query_.certain ? 0.0f : reach.most_of_b;
    return probe;
  }

  bool isDone() const { return results_.witness.has_value(); }

  void close(std::uint32_t index, std::uint32_t lane)
  {
    open_lanes_[index] &= static_cast<std::uint8_t>(~(1u << lane));
  }

  /// Whether poses are taken one by one: where they are few, and the reach is longer than any child is wide, or a plane
  /// lies beside the model. A single pose has distances, which bound those of a whole node. At a single pose nothing
  /// strays across the plane.
  bool isWorthEachPose(const VoxelMotion& motion, float largest) const
  {
    return leaves_.isWorthEachPose(motion) &&
           (leaves_.hasPlane() || query_.reach > 2 * static_cast<double>(voxel_frame_.seenRadius(largest)));
  }

  /// Bounds the distances of children at one pose. Every box holds a point of the model. So no point of a child is
  /// farther from the model than from the farthest corner of any box. Points of the model beyond that are not the
  /// nearest of any of its points.
  void boundDistances(NodeVisit& visit, std::uint32_t index, const VoxelMotion& motion)
  {
    const std::uint32_t count = voxel_->nodes[index].count;
    if (!query_.nearestDecides() || !(motion.near > *std::min_element(visit.radius, visit.radius + count))) return;
    alignas(64) float corner[kLanes];
    std::fill(corner, corner + kLanes, std::numeric_limits<float>::infinity());
    for (const Siblings& candidate : visit.candidates)
      for (const std::uint32_t lane : Bits(candidate.lanes)) {
        const BoxEnds box(candidate[lane]);
        lowerToFarthestCorner(visit.children.start, box.low, box.high, corner);
        results_.work.node_pairs += count;
      }
    for (std::uint32_t lane = 0; lane < count; ++lane) {
      visit.bound[lane] = voxel_frame_.highOfBox(motion, corner[lane], visit.radius[lane]);
      visit.near_squared[lane] = voxel_frame_.nearSquared(motion, visit.bound[lane]);
    }
  }

  /// Settles children all of whose points collide with a single point of the model at one pose.
  void settleByPoints(NodeVisit& visit, std::uint32_t index, const VoxelMotion& motion)
  {
    const Node& node = voxel_->nodes[index];
    float smallest = std::numeric_limits<float>::infinity();
    for (std::uint32_t lane = 0; lane < node.count; ++lane) smallest = std::min(smallest, visit.radius[lane]);
    if (!(settled_reach_ > smallest) && query_.of_pairs.isOne()) return;
    for (const Siblings& candidate : visit.candidates)
      for (const std::uint32_t lane : Bits(candidate.lanes)) {
        pulse_.step();
        settleBy(candidate[lane], visit, index, motion);
        if (open_lanes_[index] == 0) return;
      }
  }

  /// Settles such children by the points in one box of the model.
  void settleBy(const ModelBox& candidate, const NodeVisit& visit, std::uint32_t index, const VoxelMotion& motion)
  {
    ClippedSegments<kLanes> clipped;
    const BoxEnds box(candidate);
    results_.work.node_pairs += static_cast<std::uint64_t>(std::popcount(open_lanes_[index]));
    const std::uint32_t near =
        open_lanes_[index] & segmentsInBox(visit.children, box.low, box.high, motion.steps, &clipped);
    for (const std::uint32_t lane : Bits(near)) {
      ProbeSphere probe = probeOf(index, lane, visit.radius[lane]);
      if (!(probe.reach > 0.0f)) continue;
      const double middle = 0.5 * (std::max(clipped.from[lane], 0.0f) + std::min(clipped.to[lane], 1.0f));
      const double steps = motion.interval->last - motion.interval->first; // beyond 2^24, motion.steps may be more
      probe.pose = motion.interval->first + static_cast<std::uint32_t>(std::lround(middle * steps));
      const float reach = probe.reach + probe.farther;
      const AffineMap map = voxel_frame_.mapAt(query_.path.poses[probe.pose], {0, 0, 0}, 1.0);
      const Point center = carryPoint(map.m, map.g, probe.center);
      ++results_.work.volumes_carried;
      if (box.squaredDistance(center) > reach * reach ||
          !model_.hasPoint(voxel_frame_, candidate, probe, center, motion))
        continue;
      settle(index, lane);
      close(index, lane);
    }
  }

  /// All points of a child collide.
  void settle(std::uint32_t index, std::uint32_t lane)
  {
    const Node& node = voxel_->nodes[index];
    if (node.isLeaf(lane)) {
      const auto all = static_cast<std::uint16_t>(firstBits(node.comparedPoints(lane)));
      results_.hit[index * kLanes + lane] = results_.settled[index * kLanes + lane] = all;
      return;
    }
    const std::uint32_t below = node.child[lane];
    for (std::uint32_t i = 0; i < voxel_->nodes[below].count; ++i) settle(below, i);
  }

  /// Compares boxes of the model with the visit's children in `lanes`. For each child, a box is dropped, kept for the
  /// child's own descent, or opened.
  void take(NodeVisit& visit, const Siblings& candidate, const VoxelMotion& motion, std::uint32_t lanes)
  {
    std::uint32_t kept[kLanes] = {};
    pulse_.step();
    for (const std::uint32_t k : Bits(candidate.lanes)) {
      const ModelBox box = candidate[k];
      const BoxEnds ends(box);
      results_.work.node_pairs += static_cast<std::uint64_t>(std::popcount(lanes));
      const std::uint32_t near_lanes =
          lanes & (motion.at_rest ? boxesNearBox(visit.low, visit.high, ends.low, ends.high, visit.near_squared)
                                  : segmentsInBox(visit.children, ends.low, ends.high, motion.steps,
                                                  static_cast<ClippedSegments<kLanes>*>(nullptr)));
      if (near_lanes == 0) continue;
      const bool opens = !box.isLeaf() && model_.mayOpen(box) && !model_.isBlunt(box, motion);
      const float size = box.size(query_.boxes.stretch);
      std::uint32_t opening = 0;
      for (const std::uint32_t lane : Bits(near_lanes)) {
        if (opens && size > kBoxSize * visit.radius[lane])
          opening |= 1u << lane;
        else
          kept[lane] |= 1u << k;
      }
      if (opening != 0) take(visit, model_.near(visit.around, model_.below(box), motion.steps), motion, opening);
    }
    for (const std::uint32_t lane : Bits(lanes))
      if (kept[lane] != 0) visit.near[lane].push_back(candidate.only(kept[lane]));
  }

  const TrajectoryQuery& query_;
  const StopRule& rule_;
  const std::uint32_t index_;
  const VoxelInModelFrame voxel_frame_;
  OrientedBoxes oriented_boxes_;
  VoxelResults results_;
  ListWalk<NodeVisit> walk_;
  WorkPulse pulse_{results_.work};
  ModelBoxes model_;
  LeafWalk leaves_;
  const float settled_reach_;             // pairs nearer in floats collide; probeOf() adds points' own uncertainties
  const bool settling_;                   // whether one pose and one point of the model answer the request
  const Voxel* voxel_ = nullptr;          // once it was entered
  const OwnUncertainties* own_ = nullptr; // of its points, once it was entered
  std::vector<std::uint8_t> open_lanes_;  // per node: children that are not settled
};

} // namespace

VoxelResult walkVoxelOnTarget(const TrajectoryQuery& query, const StopRule& rule, std::span<const NearVoxel> near)
{
  thread_local WalkScratch scratch; // kept from voxel to voxel for its storage only
  return TrajectoryWalk(query, rule, near.front().voxel, scratch).run(near);
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(walkVoxelOnTarget);

VoxelResult walkVoxel(const TrajectoryQuery& query, const StopRule& rule, std::span<const NearVoxel> near_voxel)
{
  return HWY_DYNAMIC_DISPATCH(walkVoxelOnTarget)(query, rule, near_voxel);
}

} // namespace pcl_bsh
#endif
