// SPDX-License-Identifier: BSD-3-Clause
// The walk that flags the points of one voxel of a. Every node of a carries the list of the nodes of b that can still
// matter, so that the points of a share one descent. A point is settled at its first neighbour, a node as soon as all
// of its points are proven to be within the clearance of some point of b.

#if defined(PCL_BSH_FLAGS_WALK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_FLAGS_WALK_INL_H_
#undef PCL_BSH_FLAGS_WALK_INL_H_
#else
#define PCL_BSH_FLAGS_WALK_INL_H_
#endif

#include <pcl_bsh/base/kept_scratch.h>
#include <pcl_bsh/flags/apart-inl.h>
#include <pcl_bsh/flags/leaf-inl.h>
#include <pcl_bsh/flags/query.h>
#include <pcl_bsh/flags/runs-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

/// @tparam Sink is called with the result of each point, once in a walk but for some that collide: collide(record);
///   perhaps(record) where points are uncertain and it may, before collide() if that turns out to be so for certain;
///   free(record) if takesFree(); leave(record) for undecided points if takesUndecided(); leaveAll() if no point of the
///   voxel was tested
template <class Sink>
class FlagWalk {
public:
  FlagWalk(const FlagQuery& query, const StopRule& rule, Sink& sink, FlagScratch& scratch)
  : query_(query),
    a_(query.a),
    b_(query.b),
    pairs_(query.pairs),
    rule_(rule),
    sink_(sink),
    visits_(scratch.visits),
    obstacles_(scratch.obstacles),
    spheres_(scratch.spheres),
    reached_(scratch.reached),
    uncertain_(query, scratch.uncertain)
  {
    obstacles_.clear();
    spheres_.clear();
    reached_.clear();
  }

  /// Flags the points of one voxel of a.
  void run(std::uint32_t voxel)
  {
    const RelativeFrame above(a_.frame(voxel), a_.pose, b_.frame(kAboveVoxels), b_.pose, query_.rotation);
    if (rule_.mayStop() && rule_.isSpent(found.work.node_pairs)) return leaveAll();
    const bool apart = above.separates(pairs_.clearance + a_.storage.largest_radius + b_.storage.largest_radius);
    if (!apart) ++found.work.volumes_carried; // the voxel's own sphere
    const bool all = !apart && !reach(voxel, above, b_.storage.top[0]);
    if (all) return a_.storage.forEachRecord(voxel, [this](std::uint32_t record) { sink_.collide(record); });
    if (apart || reached_.empty()) {
      if (sink_.takesFree()) a_.storage.forEachRecord(voxel, [this](std::uint32_t record) { sink_.free(record); });
      return;
    }
    if (!mayEnter(voxel)) return leaveAll();
    for (const std::uint32_t other : reached_) {
      const RelativeFrame frame(a_.frame(voxel), a_.pose, b_.frame(other), b_.pose, query_.rotation);
      const Node& root = b_.voxel(other, found.work).nodes[0];
      for (std::uint32_t lane = 0; lane < root.count; ++lane)
        spheres_.push_back({&root, static_cast<std::uint16_t>(lane), 1, static_cast<std::uint32_t>(obstacles_.size())});
      obstacles_.push_back({&b_.storage.voxels[other], frame, frame.pruneReach(pairs_.clearance),
                            frame.acceptReach(query_.surePairs().reach.least),
                            frame.acceptReach(query_.surely.accepted), frame.bluntRadius(), query_.surely.band(frame),
                            query_.acceptance.band(frame)});
    }
    // Within one cloud, the work would depend on which thread comes first. Of other clouds, see mayUseKnownSlabs().
    if (mayUseKnownSlabs() && &a_.storage != &b_.storage &&
        flagRuns(a_.storage, voxel, obstacles_, query_, sink_, found.work))
      return;
    voxel_ = voxel;
    a_voxel_ = &a_.voxel(voxel, found.work);
    knows_slabs_ = mayUseKnownSlabs() && a_.storage.voxels[voxel].slabs.isFitted();
    if (query_.certain) uncertain_.begin(a_, voxel, b_, reached_, obstacles_);
    descend(a_voxel_->nodes[0], {{0.0f, 0.0f, 0.0f}, a_voxel_->radius}, spheres_, 0, false);
  }

  FlaggedVoxel found;

private:
  /// Whether the walk may go below voxels, and has the time to build those that it needs.
  bool mayEnter(std::uint32_t voxel) const
  {
    if (rule_.deepest == 0 || rule_.isSpent(found.work.node_pairs)) return false;
    if (!rule_.isTimed()) return true;
    std::size_t points = a_.storage.pointsToBuild(voxel);
    for (const std::uint32_t other : reached_) points += b_.storage.pointsToBuild(other);
    return rule_.leavesTimeToBuild(points);
  }

  /// Slabs that earlier queries have fitted are used at once, if for exact answers: these are the same with slabs and
  /// without. No other answer may depend on what was asked before. Of fresh voxels, a query that runs at the same time
  /// may fit them or not; the work then depends on that, the result does not.
  bool mayUseKnownSlabs() const { return !rule_.mayStop() && query_.surely.exact; }

  bool knowsSlabs(std::uint32_t obstacle) const
  {
    return knows_slabs_ && b_.storage.voxels[reached_[obstacle]].slabs.isFitted();
  }

  /// Collects the voxels of b that the voxel of a can reach. @return false when all of its points collide.
  bool reach(std::uint32_t voxel, const RelativeFrame& frame, const Node& node)
  {
    const float radius = a_.storage.voxels[voxel].radius * frame.stretch_a;
    const QueryBall ball{frame.g[0], frame.g[1], frame.g[2], radius + frame.pruneReach(pairs_.clearance),
                         frame.acceptReach(query_.surely.accepted) - radius * (1.0f + kSphereMargin)};
    const SphereLanes spheres{node.x, node.y, node.z, node.r, frame.stretch_b};
    found.work.node_pairs += node.count;
    if ((spheresInside(spheres, ball) & firstBits(node.count)) != 0) return false;
    for (std::uint32_t near = spheresNear(spheres, ball, nullptr) & firstBits(node.count); near != 0;
         near &= near - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(near));
      if (node.isLeaf(lane))
        reached_.push_back(node.begin[lane]);
      else if (!reach(voxel, frame, b_.storage.top[node.child[lane]]))
        return false;
    }
    return true;
  }

  /// Takes a node of a, all its children at once, through its candidates; then its inner children through theirs.
  /// @param may_collide all points below the node, where they are uncertain
  void descend(const Node& node, const BoundingSphere& around, const std::vector<ObstacleSphere>& candidates,
               std::size_t depth, bool may_collide)
  {
    if (rule_.mayStop() && rule_.isSpent(found.work.node_pairs)) return leave(node.begin[0], node.begin[node.count]);
    if (visits_.size() == depth) visits_.emplace_back();
    FlagVisit& visit = visits_[depth];
    visit.begin(node, around, may_collide);
    for (auto from = candidates.begin(); from != candidates.end() && visit.open != 0;) {
      const auto to =
          std::find_if(from, candidates.end(), [&](const ObstacleSphere& c) { return c.obstacle != from->obstacle; });
      enter(visit, from->obstacle);
      visit.has_slabs = (candidates.size() > kManyCandidates || knowsSlabs(visit.obstacle)) && takeSlabs(visit);
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
    if (rule_.mayStop()) clear(visit);
    if (query_.certain) uncertain_.report(visit, sink_);
    for (std::uint32_t bits = visit.open & ~visit.leaves; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
      if (visit.near[lane].empty()) continue;
      if (depth + 1 >= rule_.deepest) {
        leave(node.begin[lane], node.begin[lane + 1]);
        continue;
      }
      const BoundingSphere child{{node.x[lane], node.y[lane], node.z[lane]}, node.r[lane]};
      descend(a_voxel_->nodes[node.child[lane]], child, visit.near[lane], depth + 1, (visit.known >> lane & 1) != 0);
    }
  }

  /// Where the walk may stop early: reports to the sink which points met nothing of b, and which stay undecided.
  void clear(const FlagVisit& visit)
  {
    for (std::uint32_t bits = visit.open; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
      const std::uint32_t begin = visit.node->begin[lane], end = visit.node->begin[lane + 1];
      const bool unsure = (visit.unsure >> lane & 1) != 0;
      if ((visit.leaves >> lane & 1) == 0) {
        if (visit.near[lane].empty() && (visit.known >> lane & 1) == 0) free(begin, end);
      }
      else if (visit.node->isCoincident(lane)) {
        if (visit.perhaps[lane] == 0) unsure ? leave(begin, end) : free(begin, end);
      }
      else {
        for (std::uint32_t points = visit.open_points[lane] & ~visit.perhaps[lane]; points != 0; points &= points - 1) {
          const std::uint32_t i = begin + static_cast<std::uint32_t>(std::countr_zero(points));
          unsure ? leave(i, i + 1) : free(i, i + 1);
        }
      }
    }
  }

  /// Turns to a voxel of b: spheres go to its frame now, points when they are needed.
  void enter(FlagVisit& visit, std::uint32_t obstacle)
  {
    visit.obstacle = obstacle;
    const RelativeFrame& frame = obstacles_[obstacle].frame;
    carry(frame.m.data(), frame.g.data(), visit.node->x, visit.node->y, visit.node->z, kLanes, visit.x, visit.y,
          visit.z);
    const Point center = carryPoint(frame.m.data(), frame.g.data(), visit.around.center);
    found.work.volumes_carried +=
        visit.node->count + std::uint64_t{1}; // the children's spheres and the one around them
    visit.ball = {center.x, center.y, center.z,
                  visit.around.radius * frame.stretch_a + obstacles_[obstacle].prune_reach, 0.0f};
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

  /// Has the visit's children, and the obstacle, compared as slabs too. Where surfaces face each other across the
  /// clearance, spheres leave most of b as candidates. @return false where slabs cannot be compared
  bool takeSlabs(FlagVisit& visit)
  {
    ObstacleVoxel& obstacle = obstacles_[visit.obstacle];
    if (pairs_.haveRadii() || obstacle.voxel->frame.unit != a_voxel_->frame.unit) return false;
    if (!obstacle.slabs)
      obstacle.slabs = b_.storage.voxels[reached_[visit.obstacle]].slabs.of(*obstacle.voxel, found.work);
    visit.slabs = a_.storage.voxels[voxel_].slabs.of(*a_voxel_, found.work) + (visit.node - a_voxel_->nodes.data());
    constexpr float nowhere[3] = {0.0f, 0.0f, 0.0f};
    carry(obstacle.frame.m.data(), nowhere, visit.slabs->x, visit.slabs->y, visit.slabs->z, kLanes, visit.nx, visit.ny,
          visit.nz);
    return true;
  }

  ComparedSides sidesOf(const FlagVisit& visit) const
  {
    return {a_.storage.voxels[voxel_],
            {a_.pose, a_.storage.view},
            b_.storage.voxels[reached_[visit.obstacle]],
            {b_.pose, b_.storage.view}};
  }

  /// Compares a sphere of b with those children of the visit that are in `lanes`: settles them, drops it, keeps it for
  /// their own descent, or opens it.
  void take(FlagVisit& visit, const ObstacleSphere& candidate, std::uint32_t lanes)
  {
    const ObstacleVoxel& obstacle = obstacles_[visit.obstacle];
    const Node& node = *candidate.node;
    const std::uint32_t k = candidate.lane;
    const float radius = node.r[k] * obstacle.frame.stretch_b;
    const QueryBall ball{node.x[k], node.y[k], node.z[k], radius + obstacle.prune_reach,
                         obstacle.accept_reach - radius * (1.0f + kSphereMargin)};
    const SphereLanes spheres{visit.x, visit.y, visit.z, visit.r, 1.0f};
    lanes &= visit.open;
    found.work.node_pairs += static_cast<std::uint64_t>(std::popcount(lanes));
    std::uint32_t near = lanes & (query_.certain ? uncertain_.near(visit, obstacle, candidate, lanes)
                                                 : spheresNear(spheres, ball, nullptr));
    if (near == 0) return;
    if (visit.has_slabs && (near &= ~slabsApartFrom(visit, obstacle, candidate, radius)) == 0) return;
    if (radius <= obstacle.blunt_radius &&
        (near &= ~apartAsGiven(obstacle, sidesOf(visit), visit, candidate, ball, pairs_, near, found.work)) == 0)
      return;
    const bool has_large_leaf =
        candidate.isLeaf() ? radius > kLargeLeaf * visit.smallest : visit.largest_leaf > kLargeLeaf * radius;
    if (HWY_UNLIKELY(has_large_leaf) &&
        (near &= ~leavesApart(obstacle, *a_voxel_, visit, candidate, ball, pairs_, near, found.work)) == 0)
      return;
    if (visit.has_several && mayBeFar(obstacle.prune_reach, radius) &&
        (near &= ~farApart(obstacle, sidesOf(visit), visit, candidate, ball, pairs_, near, found.work)) == 0)
      return;
    if (ball.inside_reach > visit.smallest) {
      for (std::uint32_t bits = spheresInside(spheres, ball) & near; bits != 0; bits &= bits - 1)
        settleChild(visit, static_cast<std::uint32_t>(std::countr_zero(bits)));
      near &= visit.open;
    }
    const bool opens = !candidate.isLeaf() && candidate.level < rule_.deepest;
    std::uint32_t opening = candidate.isLeaf() ? 0 : near & visit.leaves;
    if (opening != 0 && !opens) {
      visit.unsure |= opening;
      near &= ~opening;
      opening = 0;
    }
    for (std::uint32_t bits = near & ~opening; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
      if (opens && radius > visit.r[lane])
        opening |= 1u << lane;
      else
        visit.near[lane].push_back(candidate);
    }
    if (opening == 0) return;
    const Node& below = obstacle.voxel->nodes[node.child[k]];
    const SphereLanes children{below.x, below.y, below.z, below.r, obstacle.frame.stretch_b};
    found.work.node_pairs += below.count;
    for (std::uint32_t bits = spheresNear(children, visit.ball, nullptr) & firstBits(below.count); bits != 0;
         bits &= bits - 1) {
      if ((opening & visit.open) == 0) return;
      take(visit, candidate.below(below, static_cast<std::uint32_t>(std::countr_zero(bits))), opening);
    }
  }

  /// Where the clearance exceeds the radius of a child, a single point of b near its centre settles all of it.
  HWY_INLINE void settleByPoints(FlagVisit& visit, const ObstacleSphere& candidate)
  {
    const ObstacleVoxel& obstacle = obstacles_[visit.obstacle];
    if (!(obstacle.sure_reach > visit.smallest)) return;
    const Node& node = *candidate.node;
    const std::uint32_t k = candidate.lane;
    // A point of the candidate can be that near only if its sphere comes within the clearance less the child's radius.
    const SphereLanes less_radius{visit.x, visit.y, visit.z, visit.r, -1.0f};
    const QueryBall ball{node.x[k], node.y[k], node.z[k], node.r[k] * obstacle.frame.stretch_b + obstacle.sure_reach,
                         0.0f};
    found.work.node_pairs += static_cast<std::uint64_t>(std::popcount(visit.open));
    for (std::uint32_t bits = spheresNear(less_radius, ball, nullptr) & visit.open; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
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
    for (std::uint32_t bits = visit.leaves & visit.open; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
      if (visit.near[lane].empty()) continue;
      const LeafRange leaf{a_voxel_, visit.node->begin[lane], visit.node->comparedPoints(lane)};
      LeafPoints points;
      carryLeaf(obstacles_[visit.obstacle].frame, leaf, points);
      const std::uint32_t hit = collidingPoints(visit, lane, leaf, points);
      for (std::uint32_t set = hit; set != 0; set &= set - 1)
        sink_.collide(leaf.record(static_cast<std::uint32_t>(std::countr_zero(set))));
      visit.open_points[lane] &= ~hit;
      if (visit.open_points[lane] != 0) continue;
      visit.open &= ~(1u << lane);
      settle(leaf.begin + leaf.count, visit.node->begin[lane + 1]); // those at the place of the one that was compared
    }
  }

  /// Which open points of a leaf, carried to the obstacle voxel, collide with the leaves of it that the child is near
  /// to.
  std::uint32_t collidingPoints(FlagVisit& visit, std::uint32_t lane, const LeafRange& leaf, const LeafPoints& points)
  {
    const ObstacleVoxel& obstacle = obstacles_[visit.obstacle];
    if (pairs_.haveRadii()) return hitBalls(obstacle, visit, lane, leaf, points, query_, found.work);
    if (!query_.certain) return hitPoints(obstacle, visit, lane, leaf, points, pairs_, found.work);
    return hitUncertainPoints(obstacle, uncertain_.reach(visit.obstacle), visit, lane, leaf, uncertain_.own(leaf),
                              points, query_, found.work);
  }

  void settleChild(FlagVisit& visit, std::uint32_t lane)
  {
    visit.open &= ~(1u << lane);
    settle(visit.node->begin[lane], visit.node->begin[lane + 1]);
  }

  // Of the points at these places of a's voxel.
  void settle(std::uint32_t begin, std::uint32_t end)
  {
    for (std::uint32_t i = begin; i < end; ++i) sink_.collide(a_voxel_->records()[i]);
  }

  void free(std::uint32_t begin, std::uint32_t end)
  {
    if (!sink_.takesFree()) return;
    for (std::uint32_t i = begin; i < end; ++i) sink_.free(a_voxel_->records()[i]);
  }

  void leave(std::uint32_t begin, std::uint32_t end)
  {
    found.undecided = true;
    if (!sink_.takesUndecided()) return;
    for (std::uint32_t i = begin; i < end; ++i) sink_.leave(a_voxel_->records()[i]);
  }

  void leaveAll()
  {
    found.undecided = true;
    sink_.leaveAll();
  }

  const FlagQuery& query_;
  const Spaces a_, b_;
  const PointPairs& pairs_;
  const StopRule& rule_;
  Sink& sink_;
  static constexpr std::size_t kManyCandidates = 256;   ///< as they are where surfaces face each other
  static constexpr std::size_t kSeveralCandidates = 64; ///< as the clearance leaves them about what is far smaller

  std::uint32_t voxel_ = kNoVoxel; ///< of a
  bool knows_slabs_ = false;       ///< whether those of a's voxel may be used without fitting any
  const Voxel* a_voxel_ = nullptr;
  std::deque<FlagVisit>& visits_;
  std::vector<ObstacleVoxel>& obstacles_;
  std::vector<ObstacleSphere>& spheres_; ///< of the obstacles' roots
  std::vector<std::uint32_t>& reached_;
  UncertainWalk uncertain_; ///< where points are
};

/// One walk through a voxel of a, in memory that the thread keeps.
template <class Sink>
FlaggedVoxel walkVoxel(const FlagQuery& query, const StopRule& rule, std::uint32_t voxel, Sink& sink)
{
  const ScratchLease<FlagScratch> scratch;
  FlagWalk walk(query, rule, sink, *scratch);
  walk.run(voxel);
  return walk.found;
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle
