// SPDX-License-Identifier: BSD-3-Clause
// Where points are uncertain: reaches of nodes and points by their own uncertainties. All of these are bounds in float,
// rounded to the safe side; what lies between is decided pair by pair.

#if defined(PCL_BSH_FLAGS_UNCERTAIN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_FLAGS_UNCERTAIN_INL_H_
#undef PCL_BSH_FLAGS_UNCERTAIN_INL_H_
#else
#define PCL_BSH_FLAGS_UNCERTAIN_INL_H_
#endif

#include <pcl_bsh/flags/query.h>
#include <pcl_bsh/flags/visit-inl.h>
#include <pcl_bsh/traversal/uncertain_points-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// The reaches of a visit's children, in the obstacle voxel's frame.
struct UncertainLanes {
  alignas(32) float sure[kLanes];      ///< a point so near to the centre makes all below collide for certain
  alignas(32) float maybe[kLanes];     ///< a point so near to the centre makes all below possible: they may collide
  alignas(32) float sure_near[kLanes]; ///< what is farther from the centre makes nothing below collide for certain
  alignas(32) float near[kLanes];      ///< what is farther from the centre makes nothing below possible
  std::uint32_t may_be_sure = 0;       ///< children that a point may be within `sure` of, a bit each
  std::uint32_t may_be_possible = 0;

  /// @param r the children's radii in the obstacle's frame. @param own the children's least and greatest uncertainties
  void set(const UncertainReach& reach, const float* r, const UncertaintyLanes& own)
  {
    for (std::size_t i = 0; i < kLanes; ++i) {
      const float least = own.least[i] * reach.scale_down, most = own.most[i] * reach.scale_up;
      const float size = r[i] + most + reach.magnitude;
      const float slack = size * kSumMargin;
      sure[i] = reach.sure - r[i] - most - slack;
      maybe[i] = reach.maybe - r[i] + least - slack;
      sure_near[i] = reach.sure_near + r[i] - least + slack;
      near[i] = reach.near + r[i] + most + slack;
    }
    may_be_sure = may_be_possible = 0;
    for (std::uint32_t i = 0; i < kLanes; ++i) {
      may_be_sure |= (sure[i] > 0.0f ? 1u : 0u) << i;
      may_be_possible |= (maybe[i] + reach.most_of_b > 0.0f ? 1u : 0u) << i;
    }
  }
};

/// The uncertainties of a node's children; zeros where points have none of their own.
inline const UncertaintyLanes& ownOf(const OwnUncertainties* own, std::size_t node)
{
  static constexpr UncertaintyLanes kNone{};
  return own ? own->nodes[node] : kNone;
}

/// The part of a candidate in the reach of a pair of nodes.
struct CandidateReach {
  float sure, maybe; ///< to be added to a child's `sure_near` and `near`, or where points are looked for

  CandidateReach(const ObstacleVoxel& obstacle, const UncertainReach& reach, const ObstacleSphere& candidate)
  {
    const Node& node = *candidate.node;
    const UncertaintyLanes& own =
        ownOf(reach.of_b, static_cast<std::size_t>(candidate.node - obstacle.voxel->nodes.data()));
    const float radius = node.r[candidate.lane] * obstacle.frame.stretch_b;
    const float least = own.least[candidate.lane] * reach.scale_down, most = own.most[candidate.lane] * reach.scale_up;
    const float slack = (radius + most) * kSumMargin;
    sure = radius - least + slack;
    maybe = radius + most + slack;
  }
};

/// Finds points of b by their distance and their uncertainty, for hasPointWithin().
class UncertainPoint {
public:
  /// @param certain whether the uncertainty shortens the reach, as it does for certain collisions; else it lengthens it
  UncertainPoint(const ObstacleVoxel& obstacle, const UncertainReach& reach, bool certain)
  : voxel_(*obstacle.voxel),
    stretch_(obstacle.frame.stretch_b),
    own_(reach.of_b),
    scale_(certain ? -reach.scale_up * (1.0f + kReachMargin) : reach.scale_down * (1.0f - kReachMargin)),
    certain_(certain)
  {
  }

  bool isIn(const LeafRange& leaf, const QueryBall& ball) const
  {
    return anyPointWithinEach(leaf.x(), leaf.y(), leaf.z(), ownOf(own_, leaf), scale_, leaf.count,
                              {ball.x, ball.y, ball.z}, ball.near_reach);
  }

  std::uint32_t spheresIn(const Node& node, const QueryBall& ball, float* gap) const
  {
    const UncertaintyLanes& own = ownOf(own_, static_cast<std::size_t>(&node - voxel_.nodes.data()));
    const float* const lengths = certain_ ? own.least : own.most;
    alignas(32) float reaches[kLanes];
    for (std::size_t i = 0; i < kLanes; ++i) reaches[i] = node.r[i] * stretch_ + lengths[i] * scale_;
    return spheresNearEach({node.x, node.y, node.z, node.r, 1.0f}, reaches, {ball.x, ball.y, ball.z}, ball.near_reach,
                           gap);
  }

private:
  const Voxel& voxel_;
  const float stretch_;
  const OwnUncertainties* own_;
  const float scale_;
  const bool certain_;
};

/// The part of a walk through a voxel of a for uncertain points. A node is settled as soon as all of its points are
/// known to collide for certain. Before that, it may be known that all of them may collide: from then on only points of
/// b matter that may make some certain, and the rest stays undecided.
class UncertainWalk {
public:
  UncertainWalk(const FlagQuery& query, std::vector<UncertainReach>& reaches) : query_(query), reaches_(reaches)
  {
    reaches_.clear();
  }

  /// @param voxel of a, built, as those of b are. @param reached their numbers
  void begin(const Spaces& a, std::uint32_t voxel, const Spaces& b, const std::vector<std::uint32_t>& reached,
             const std::vector<ObstacleVoxel>& obstacles)
  {
    const PairReach& of_pairs = query_.pairs.ofPairs();
    voxel_ = &a.storage.voxels[voxel];
    own_ = ownUncertainties(a.storage, voxel);
    for (std::size_t i = 0; i < obstacles.size(); ++i) {
      const RelativeFrame& frame = obstacles[i].frame;
      const OwnUncertainties* const of_b = ownUncertainties(b.storage, reached[i]);
      reaches_.emplace_back(frame.error + b.storage.view.off_middle / obstacles[i].voxel->frame.unit, frame.skew(),
                            obstacles[i].voxel->frame.unit, of_pairs.leastInCommon(), of_pairs.mostInCommon(),
                            of_b ? static_cast<double>(of_b->most) : 0.0,
                            frame.pruneReach(query_.pairs.reach.length()));
      reaches_.back().of_b = of_b;
    }
  }

  const UncertainReach& reach(std::uint32_t obstacle) const { return reaches_[obstacle]; }
  const float* own(const LeafRange& leaf) const { return ownOf(own_, leaf); } ///< of points of a

  /// Turns to the visit's obstacle, and settles the children that single points of b are near enough to.
  /// @param from, to candidates. @param settleChild(lane)
  template <class Candidate, class Settle>
  HWY_NOINLINE void settle(FlagVisit& visit, const ObstacleVoxel& obstacle, Candidate from, Candidate to, Work& work,
                           const Settle& settleChild)
  {
    const UncertainReach& reach = reaches_[visit.obstacle];
    lanes_.set(reach, visit.r, ownOf(own_, static_cast<std::size_t>(visit.node - voxel_->nodes.data())));
    const UncertainPoint certain(obstacle, reach, true), possible(obstacle, reach, false);
    for (auto c = from; c != to && (visit.open & lanes_.may_be_sure) != 0; ++c) {
      const std::uint32_t settled =
          withPointsWithin(certain, visit, obstacle, *c, lanes_.sure, CandidateReach(obstacle, reach, *c).sure,
                           visit.open & lanes_.may_be_sure, work);
      for (const std::uint32_t lane : Bits(settled)) settleChild(lane);
    }
    const auto unknown = [&] { return visit.open & ~visit.known & lanes_.may_be_possible; };
    for (auto c = from; c != to && unknown() != 0; ++c)
      know(visit, withPointsWithin(possible, visit, obstacle, *c, lanes_.maybe,
                                   CandidateReach(obstacle, reach, *c).maybe, unknown(), work));
    if ((visit.open & ~visit.known) == 0)
      visit.ball.near_reach = std::max(0.0f, visit.around.radius * obstacle.frame.stretch_a + reach.sure_near +
                                                 std::abs(reach.sure_near) * kReachMargin);
  }

  /// Which of these children the candidate matters to.
  HWY_NOINLINE std::uint32_t near(const FlagVisit& visit, const ObstacleVoxel& obstacle,
                                  const ObstacleSphere& candidate, std::uint32_t lanes) const
  {
    const CandidateReach more(obstacle, reaches_[visit.obstacle], candidate);
    const SphereLanes spheres{visit.x, visit.y, visit.z, visit.r, 1.0f};
    const Point to = centerOf(candidate);
    std::uint32_t near = 0;
    if ((lanes & visit.known) != 0)
      near |= visit.known & spheresNearEach(spheres, lanes_.sure_near, to, more.sure, nullptr);
    if ((lanes & ~visit.known) != 0)
      near |= ~visit.known & spheresNearEach(spheres, lanes_.near, to, more.maybe, nullptr);
    return near;
  }

  /// Tells the writer which points may collide, of the open children that are done with.
  HWY_NOINLINE void report(const FlagVisit& visit, FlagWriter& writer) const
  {
    for (const std::uint32_t lane : Bits(visit.open)) {
      const bool is_leaf = (visit.leaves >> lane & 1) != 0;
      std::uint32_t points = is_leaf ? visit.perhaps[lane] & visit.open_points[lane] : 0;
      const bool all = is_leaf ? points != 0 && visit.node->isCoincident(lane)
                               : (visit.known >> lane & 1) != 0 && visit.near[lane].empty();
      const std::uint32_t *const first = voxel_->records() + visit.node->begin[lane], *const last =
                                                                                          voxel_->records() +
                                                                                          visit.node->begin[lane + 1];
      if (all)
        writer.tell(Finding::possible, first, last);
      else
        tellBits(writer, Finding::possible, points, [first](std::uint32_t i) { return first[i]; });
    }
  }

private:
  static Point centerOf(const ObstacleSphere& candidate)
  {
    const Node& node = *candidate.node;
    return {node.x[candidate.lane], node.y[candidate.lane], node.z[candidate.lane]};
  }

  /// The children that have a point of the candidate within the child's reach of its centre.
  static std::uint32_t withPointsWithin(const UncertainPoint& finder, const FlagVisit& visit,
                                        const ObstacleVoxel& obstacle, const ObstacleSphere& candidate,
                                        const float* reaches, float more, std::uint32_t lanes, Work& work)
  {
    work.node_pairs += static_cast<std::uint64_t>(std::popcount(lanes));
    lanes &= spheresNearEach({visit.x, visit.y, visit.z, visit.r, 1.0f}, reaches, centerOf(candidate), more, nullptr);
    std::uint32_t within = 0;
    for (const std::uint32_t lane : Bits(lanes)) {
      const QueryBall center{visit.x[lane], visit.y[lane], visit.z[lane], reaches[lane], 0.0f};
      if (hasPointWithin(finder, obstacle, candidate, center, work)) within |= 1u << lane;
    }
    return within;
  }

  /// Takes note that all points below these children may collide.
  static void know(FlagVisit& visit, std::uint32_t lanes)
  {
    visit.known |= lanes;
    for (const std::uint32_t lane : Bits(lanes & visit.leaves)) visit.perhaps[lane] = visit.open_points[lane];
  }

  const FlagQuery& query_;
  const Voxel* voxel_ = nullptr;          ///< of a
  const OwnUncertainties* own_ = nullptr; ///< of its points
  std::vector<UncertainReach>& reaches_;  ///< to the obstacles
  UncertainLanes lanes_;                  ///< of the visit and its obstacle
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
