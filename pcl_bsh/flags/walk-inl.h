// SPDX-License-Identifier: BSD-3-Clause
// The walk that flags the points of one voxel of a. A node's list holds the spheres of b that can still matter. A point
// is settled at its first neighbour. A node is settled as soon as all of its points are proven to be within the
// clearance of some point of b.

#if defined(PCL_BSH_FLAGS_WALK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_FLAGS_WALK_INL_H_
#undef PCL_BSH_FLAGS_WALK_INL_H_
#else
#define PCL_BSH_FLAGS_WALK_INL_H_
#endif

#include <pcl_bsh/base/kept_scratch.h>
#include <pcl_bsh/flags/leaf-inl.h>
#include <pcl_bsh/flags/reached_voxels-inl.h>
#include <pcl_bsh/flags/runs-inl.h>
#include <pcl_bsh/traversal/beyond_reach.h>
#include <pcl_bsh/traversal/separation-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

class FlagWalk : public ListVisitor<FlagVisit> {
public:
  FlagWalk(const FlagQuery& query, const StopRule& rule, FlagWriter& writer, FlagScratch& scratch)
  : query_(query),
    a_(query.a),
    b_(query.b),
    pairs_(query.pairs),
    reach_(pairs_.reach.length()),
    rule_(rule),
    writer_(writer),
    walk_(rule, found.work.node_pairs, scratch.visits),
    reached_(query, a_, b_, scratch, found.work),
    obstacles_(reached_.obstacles),
    flat_(scratch.flat),
    slabs_(a_, b_, pairs_.ofTriangles(), reached_.obstacles, reached_.numbers, found.work),
    uncertain_(query, scratch.uncertain),
    separation_(pairs_.distance, a_, b_, found.work)
  {
  }

  /// Flags the points of one voxel of a.
  void run(std::uint32_t voxel)
  {
    if (rule_.isSpent(found.work.node_pairs)) return leaveAll();
    if (const std::optional<Finding> all = reached_.find(voxel)) return writer_.tellAll(*all);
    const auto toBuild = [&] { return a_.storage.pointsToBuild(voxel) + reached_.pointsToBuild(); };
    if (rule_.isSpent(found.work.node_pairs) || !rule_.mayEnter(toBuild)) return leaveAll();
    reached_.enter(voxel, pulse_);
    allowed_ = steps() + kStepsOfVoxel;
    if (b_.storage.view.triangles && !reached_.haveTrianglesNear(voxel, slabs_, [this] { return steps() > allowed_; }))
      return writer_.tellAll(Finding::free);
    allowed_ += kMostStepsPerPoint * a_.storage.voxels[voxel].count;
    // Within one cloud, the work would depend on which thread comes first. For two clouds, see mayUseKnownSlabs().
    if (mayUseKnownSlabs() && &a_.storage != &b_.storage &&
        flagRuns(a_.storage, voxel, obstacles_, query_, writer_, found.work))
      return;
    voxel_ = voxel;
    a_voxel_ = &a_.voxel(voxel, found.work);
    slabs_.begin(voxel, *a_voxel_, mayUseKnownSlabs());
    if (query_.certain) uncertain_.begin(a_, voxel, b_, reached_.numbers, obstacles_);
    walk_.descend(*this, Part{NodeInSphere::rootOf(*a_voxel_), false}, reached_.spheres);
  }

  // As ListWalk asks.

  /// A node of a, and whether it is known that all points below it may collide, where they are uncertain.
  struct Part : NodeInSphere {
    bool may_collide;
  };

  void left(const Part& part, const std::vector<ObstacleSphere>&)
  {
    tell(Finding::left, part.node.begin[0], part.node.begin[part.node.count]);
  }

  std::uint32_t refine(FlagVisit& visit, const Part& part, const std::vector<ObstacleSphere>& candidates)
  {
    visit.begin(part, part.may_collide);
    for (auto from = candidates.begin(); from != candidates.end() && visit.open != 0;) {
      const auto to =
          std::find_if(from, candidates.end(), [&](const ObstacleSphere& c) { return c.obstacle != from->obstacle; });
      enter(visit, from->obstacle);
      visit.has_slabs = false;
      visit.may_have_slabs = slabs_.mayHave(visit);
      if (visit.may_have_slabs && (candidates.size() > kManyCandidates || slabs_.areKnown(visit.obstacle)))
        slabs_.take(visit);
      visit.has_several = candidates.size() > kSeveralCandidates && !pairs_.haveRadii();
      if (query_.certain)
        uncertain_.settle(visit, obstacles_[visit.obstacle], from, to, found.work,
                          [&](std::uint32_t lane) { settleChild(visit, lane); });
      else
        for (auto c = from; c != to && visit.open != 0; ++c) settleByPoints(visit, *c);
      for (auto c = from; c != to && visit.open != 0; ++c) take(visit, *c, visit.open);
      compareLeaves(visit);
      from = to;
    }
    if (rule_.mayStop()) clearLeaves(visit);
    if (query_.certain) uncertain_.report(visit, writer_);
    return visit.open & ~visit.leaves;
  }

  void alone(const FlagVisit& visit, std::uint32_t lane)
  {
    if (rule_.mayStop() && (visit.known >> lane & 1) == 0)
      tell(Finding::free, visit.node->begin[lane], visit.node->begin[lane + 1]);
  }

  Part below(const Part& part, const FlagVisit& visit, std::uint32_t lane) const
  {
    return {part.child(*a_voxel_, lane), (visit.known >> lane & 1) != 0};
  }

  FlaggedVoxel found;

private:
  /// Whether slabs that earlier queries have fitted are used at once: for exact answers, which are equal with slabs and
  /// without. No other answer may depend on what was asked before. A query that runs at the same time may fit slabs of
  /// fresh voxels or not; the work then depends on that, the result does not.
  bool mayUseKnownSlabs() const { return !rule_.mayStop() && query_.surely.exact; }

  std::uint64_t steps() const
  {
    return found.work.node_pairs + kLeafPoints * found.work.leaf_pairs + found.work.exact_decisions;
  }

  /// Where the walk may stop early: tells which points of leaves met nothing of b, and which stay undecided.
  void clearLeaves(const FlagVisit& visit)
  {
    for (const std::uint32_t lane : Bits(visit.open & visit.leaves)) {
      const std::uint32_t begin = visit.node->begin[lane], end = visit.node->begin[lane + 1];
      const Finding finding = (visit.unsure >> lane & 1) != 0 ? Finding::left : Finding::free;
      if (visit.node->isCoincident(lane)) {
        if (visit.perhaps[lane] == 0) tell(finding, begin, end);
        continue;
      }
      for (const std::uint32_t i : Bits(visit.open_points[lane] & ~visit.perhaps[lane]))
        tell(finding, begin + i, begin + i + 1);
    }
  }

  /// Turns to a voxel of b: spheres go to its frame now, points when they are needed.
  void enter(FlagVisit& visit, std::uint32_t obstacle)
  {
    visit.obstacle = obstacle;
    visit.carried = 0;
    const RelativeFrame& frame = obstacles_[obstacle].frame;
    carry(frame.m.data(), frame.g.data(), visit.node->x, visit.node->y, visit.node->z, kLanes, visit.x, visit.y,
          visit.z);
    const Point center = carryPoint(frame.m.data(), frame.g.data(), visit.around.center);
    found.work.volumes_carried +=
        visit.node->count + std::uint64_t{1}; // the children's spheres and the one around them
    visit.ball = {center.x, center.y, center.z, visit.around.radius * frame.stretch_a + obstacles_[obstacle].reach,
                  0.0f};
    visit.smallest = std::numeric_limits<float>::infinity();
    visit.largest_leaf = 0.0f;
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) visit.r[lane] = visit.node->r[lane] * frame.stretch_a;
    for (std::uint32_t lane = 0; lane < visit.node->count; ++lane) {
      visit.smallest = std::min(visit.smallest, visit.r[lane]);
      if ((visit.leaves >> lane & 1) == 0) continue;
      visit.largest_leaf = std::max(visit.largest_leaf, visit.r[lane]);
      visit.near[lane].clear();
    }
  }

  /// The children in `near` that are apart from a sphere of b, though their spheres and slabs are not.
  std::uint32_t separated(const FlagVisit& visit, const ObstacleSphere& candidate, float radius, std::uint32_t near)
  {
    const ObstacleVoxel& obstacle = obstacles_[visit.obstacle];
    const bool is_blunt = radius <= obstacle.blunt_radius;
    const bool has_large_leaf =
        candidate.isLeaf() ? radius > kLargeLeaf * visit.smallest : visit.largest_leaf > kLargeLeaf * radius;
    const bool may_be_far = visit.has_several && mayBeFar(obstacle.reach, radius);
    const bool of_triangles = a_.storage.view.triangles && (near & visit.leaves) != 0;
    if (HWY_LIKELY(!is_blunt && !has_large_leaf && !may_be_far && !of_triangles)) return 0;
    const Node& node = *candidate.node;
    const std::uint32_t k = candidate.lane;
    const Point center{node.x[k], node.y[k], node.z[k]};
    const SphereLanes children{visit.x, visit.y, visit.z, visit.r, 1.0f};
    Voxel* const other_voxel = &b_.storage.voxels[reached_.numbers[visit.obstacle]];
    const ChildrenAndSphere compared{
        obstacle.frame, true,  &a_.storage.voxels[voxel_], *visit.node, children, other_voxel, node, k, center,
        radius,         reach_};
    std::uint32_t apart = is_blunt ? separation_.asGiven(compared, near) : 0;
    if (has_large_leaf) apart |= separation_.byLeafPoints(compared, near & ~apart);
    if (of_triangles)
      apart |=
          separation_.byTriangles(compared, near & ~apart & visit.leaves, [this]() -> FlatRecords& { return flat_; });
    if (!may_be_far || (near & ~apart) == 0) return apart;
    alignas(32) float gap[kLanes];
    spheresNear(children, {center.x, center.y, center.z, 0.0f, 0.0f}, gap);
    return apart | separation_.byExtent(compared, gap, near & ~apart, true);
  }

  /// The children in `near` that triangles of a leaf may be near to, where the triangles' balls tell little. Settles
  /// children that are near enough to one triangle as a whole.
  HWY_NOINLINE std::uint32_t nearTriangles(FlagVisit& visit, const ObstacleSphere& candidate, std::uint32_t near)
  {
    const ObstacleVoxel& obstacle = obstacles_[visit.obstacle];
    const LocalFrame& frame = obstacle.voxel->frame;
    const LeafRange leaf = candidate.leaf(*obstacle.voxel);
    if (!(leaf.largestRadius() > kLargeBall * static_cast<double>(visit.smallest) * frame.unit)) return near;
    if (slabs_.isThin(visit, candidate)) return near; // slabs told what triangles can
    found.work.node_pairs += leaf.count;
    const LanesNear lanes =
        reached_.nearTo(leaf, obstacle, visit.x, visit.y, visit.z, visit.r, near, obstacle.sure_reach);
    for (const std::uint32_t lane : Bits(lanes.inside)) settleChild(visit, lane);
    return lanes.near & visit.open;
  }

  /// Compares a sphere of b with the children of the visit that are in `lanes`. Settles children, drops the sphere,
  /// keeps it for a child's own descent, or opens it.
  void take(FlagVisit& visit, const ObstacleSphere& candidate, std::uint32_t lanes)
  {
    pulse_.step();
    const ObstacleVoxel& obstacle = obstacles_[visit.obstacle];
    const Node& node = *candidate.node;
    const std::uint32_t k = candidate.lane;
    const float radius = node.r[k] * obstacle.frame.stretch_b;
    const QueryBall ball{node.x[k], node.y[k], node.z[k], radius + obstacle.reach,
                         obstacle.accept_reach - radius * (1.0f + kSphereMargin)};
    const SphereLanes spheres{visit.x, visit.y, visit.z, visit.r, 1.0f};
    lanes &= visit.open;
    found.work.node_pairs += static_cast<std::uint64_t>(std::popcount(lanes));
    std::uint32_t near = lanes & (query_.certain ? uncertain_.near(visit, obstacle, candidate, lanes)
                                                 : spheresNear(spheres, ball, nullptr));
    if (near == 0) return;
    if (HWY_UNLIKELY(beyond_.mayKnow()) && (near = notBeyond(visit, candidate, near)) == 0) return;
    if (visit.may_have_slabs) {
      if (!visit.has_slabs && pairs_.ofTriangles() && steps() > allowed_) slabs_.take(visit);
      if (visit.has_slabs && (near = slabs_.nearOf(visit, candidate, {ball.x, ball.y, ball.z}, radius, near)) == 0)
        return;
    }
    if ((near &= ~separated(visit, candidate, radius, near)) == 0) return;
    if (b_.storage.view.triangles && candidate.isLeaf() && (near = nearTriangles(visit, candidate, near)) == 0) return;
    if (ball.inside_reach > visit.smallest) {
      for (const std::uint32_t lane : Bits(spheresInside(spheres, ball) & near)) settleChild(visit, lane);
      near &= visit.open;
    }
    const bool opens = !candidate.isLeaf() && candidate.level < rule_.deepest;
    std::uint32_t opening = candidate.isLeaf() ? 0 : near & visit.leaves;
    if (!opens) {
      visit.unsure |= opening;
      near &= ~opening;
      opening = 0;
    }
    for (const std::uint32_t lane : Bits(near & ~opening)) {
      if (opens && radius > visit.r[lane])
        opening |= 1u << lane;
      else
        visit.near[lane].push_back(candidate);
    }
    if (opening == 0) return;
    const Node& below = obstacle.voxel->nodes[node.child[k]];
    const SphereLanes children{below.x, below.y, below.z, below.r, obstacle.frame.stretch_b};
    found.work.node_pairs += below.count;
    for (const std::uint32_t i : Bits(spheresNear(children, visit.ball, nullptr) & firstBits(below.count))) {
      if ((opening & visit.open) == 0) return;
      take(visit, candidate.below(below, i), opening);
    }
  }

  /// Where the clearance exceeds the radius of a child, a single point of b near its centre settles all of it.
  HWY_INLINE void settleByPoints(FlagVisit& visit, const ObstacleSphere& candidate)
  {
    const ObstacleVoxel& obstacle = obstacles_[visit.obstacle];
    if (!(obstacle.sure_reach > visit.smallest) || obstacle.has_long_triangles) return;
    const Node& node = *candidate.node;
    const std::uint32_t k = candidate.lane;
    // A point of the candidate can be that near only if its sphere comes within the clearance less the child's radius.
    const SphereLanes less_radius{visit.x, visit.y, visit.z, visit.r, -1.0f};
    const QueryBall ball{node.x[k], node.y[k], node.z[k], node.r[k] * obstacle.frame.stretch_b + obstacle.sure_reach,
                         0.0f};
    found.work.node_pairs += static_cast<std::uint64_t>(std::popcount(visit.open));
    for (const std::uint32_t lane : Bits(spheresNear(less_radius, ball, nullptr) & visit.open)) {
      const float reach = obstacle.sure_reach - visit.r[lane] * (1.0f + kSphereMargin);
      const QueryBall center{visit.x[lane], visit.y[lane], visit.z[lane], reach, 0.0f};
      if (reach > 0.0f &&
          hasPointWithin(MeasuredPoint{obstacle.frame.stretch_b}, obstacle, candidate, center, found.work))
        settleChild(visit, lane);
    }
  }

  /// Compares the points of the children that are leaves with the leaves they are near to, in this obstacle.
  void compareLeaves(FlagVisit& visit)
  {
    for (const std::uint32_t lane : Bits(visit.leaves & visit.open)) {
      if (visit.near[lane].empty()) continue;
      const LeafRange leaf = slabs_.leafOf(visit, lane);
      const std::uint32_t hit = collidingPoints(visit, lane, leaf, slabs_.carriedPoints(visit, lane));
      tellBits(writer_, Finding::colliding, hit, [&leaf](std::uint32_t i) { return leaf.record(i); });
      visit.open_points[lane] &= ~hit;
      if (visit.open_points[lane] != 0) continue;
      visit.open &= ~(1u << lane);
      tell(Finding::colliding, leaf.begin + leaf.count,
           visit.node->begin[lane + 1]); // those at the place of the one that was compared
    }
  }

  /// Which open points of a leaf, carried to the obstacle voxel, collide with its leaves near the child.
  std::uint32_t collidingPoints(FlagVisit& visit, std::uint32_t lane, const LeafRange& leaf, const LeafPoints& points)
  {
    const ObstacleVoxel& obstacle = obstacles_[visit.obstacle];
    const auto mayMatter = [&](const ObstacleSphere& candidate) {
      pulse_.look();
      return HWY_LIKELY(!beyond_.mayKnow()) || notBeyond(visit, candidate, 1u << lane) != 0;
    };
    if (b_.storage.view.triangles && a_.storage.view.radii)
      return hitByTriangles(obstacle, visit, lane, leaf, points, query_, flat_, found.work, beyond_,
                            [&](const ObstacleSphere& candidate) { return mayMatter(candidate) ? ~0u : 0; });
    if (b_.storage.view.triangles)
      return hitTriangles(obstacle, visit, lane, leaf, points, query_, flat_, found.work, beyond_,
                          [&](const ObstacleSphere& candidate) -> std::uint32_t {
                            if (!mayMatter(candidate)) return 0;
                            return visit.has_slabs ? slabs_.facingPoints(visit, points, candidate) : ~0u;
                          });
    if (pairs_.haveRadii())
      return hitBalls(obstacle, visit, lane, leaf, points, query_, found.work, beyond_,
                      [&](const ObstacleSphere& candidate) -> std::uint32_t {
                        if (!mayMatter(candidate)) return 0;
                        const LeafRange other = candidate.leaf(*obstacle.voxel);
                        return visit.has_slabs && slabs_.isLeafOfPoints(candidate)
                                   ? slabs_.facingLeaf(visit, lane, other)
                                   : firstBits(other.count);
                      });
    if (!query_.certain) return hitPoints(obstacle, visit, lane, leaf, points, pairs_, found.work);
    return hitUncertainPoints(obstacle, uncertain_.reach(visit.obstacle), visit, lane, leaf, uncertain_.own(leaf),
                              points, query_, found.work);
  }

  /// The children in `near` that are not known to be beyond the reach from a sphere of b.
  HWY_NOINLINE std::uint32_t notBeyond(const FlagVisit& visit, const ObstacleSphere& candidate, std::uint32_t near)
  {
    const NodeChild other{reached_.numbers[visit.obstacle], *candidate.node, candidate.lane};
    for (const std::uint32_t lane : Bits(near))
      if (beyond_.knows({voxel_, *visit.node, lane}, other)) near &= ~(1u << lane);
    return near;
  }

  void settleChild(FlagVisit& visit, std::uint32_t lane)
  {
    visit.open &= ~(1u << lane);
    tell(Finding::colliding, visit.node->begin[lane], visit.node->begin[lane + 1]);
  }

  /// @param begin, end places in a's voxel
  void tell(Finding finding, std::uint32_t begin, std::uint32_t end)
  {
    found.undecided = found.undecided || finding == Finding::left;
    writer_.tell(finding, a_voxel_->records() + begin, a_voxel_->records() + end);
  }

  void leaveAll()
  {
    found.undecided = true;
    writer_.tellAll(Finding::left);
  }

  const FlagQuery& query_;
  const Spaces a_, b_;
  const PointPairs& pairs_;
  const double reach_; ///< of all pairs
  const StopRule& rule_;
  FlagWriter& writer_;
  static constexpr std::size_t kManyCandidates = 256;   ///< more are left where surfaces face each other
  static constexpr std::size_t kSeveralCandidates = 64; ///< more are left about nodes far smaller than the clearance

  std::uint32_t voxel_ = kNoVoxel; ///< of a
  std::uint64_t allowed_ = 0;      ///< steps, before slabs of long triangles are fitted
  const Voxel* a_voxel_ = nullptr;
  ListWalk<FlagVisit> walk_;
  ReachedVoxels reached_;
  const std::vector<ObstacleVoxel>& obstacles_;
  FlatRecords& flat_;
  FlagSlabs slabs_;
  UncertainWalk uncertain_; ///< where points are
  const Separation separation_;
  WorkPulse pulse_{found.work};
  BeyondReach beyond_{pairs_, a_.storage, b_.storage};
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
