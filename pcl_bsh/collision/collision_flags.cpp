// SPDX-License-Identifier: BSD-3-Clause
// Flags: every node of a carries the list of what can still matter of b, so that a's points share one descent. A point
// is settled at its first neighbour, a node as soon as its farthest point must be within the clearance of something.
#include <pcl_bsh/collision/check_request.h>
#include <pcl_bsh/collision/collide.h>
#include <pcl_bsh/hierarchy/crowded_cell.h>
#include <pcl_bsh/hierarchy/parallel.h>
#include <pcl_bsh/query/acceptance.h>
#include <pcl_bsh/query/stop_rule.h>
#include <pcl_bsh/traversal/kept_visits.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/collision/collision_flags.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/traversal/leaf_pair-inl.h>

#ifndef PCL_BSH_QUERY_COLLISION_FLAGS_ONCE
#define PCL_BSH_QUERY_COLLISION_FLAGS_ONCE
namespace pcl_bsh {
namespace {

constexpr auto kFree = flagOf(Verdict::free);
constexpr auto kColliding = flagOf(Verdict::colliding);
constexpr auto kUndecided = flagOf(Verdict::undecided);

struct FlagQuery {
  const Placed& a;
  const Placed& b;
  const PointPairs& pairs;
  RelativeRotation rotation;
  Acceptance acceptance;
  bool marked; ///< whether flags start as undecided, rather than free
};

struct FlaggedVoxel {
  Work work;
  std::size_t colliding = 0; ///< points flagged so that were not before
  bool undecided = false;    ///< whether points were left so
};

} // namespace
} // namespace pcl_bsh
#endif

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {
namespace {

/// A voxel of b, as seen from a voxel of a.
struct Meeting {
  const Voxel* voxel;
  RelativeFrame frame;
  float prune_reach;
  float sure_reach;   ///< what comes within it collides
  float accept_reach; ///< what comes within it may count as colliding; no less
  float blunt_radius;
  DistanceBand band;
};

/// A sphere of b that the points of some node of a may collide with: a child of `node`, in the voxel of a meeting.
struct Candidate {
  const Node* node;
  std::uint16_t lane;
  std::uint16_t level; ///< of `node` below its voxel, from 1
  std::uint32_t meeting;

  bool isLeaf() const { return node->isLeaf(lane); }
  Candidate below(const Node& child, std::uint32_t i) const
  {
    return {&child, static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(level + 1), meeting};
  }
  LeafRange leaf(const Meeting& m) const { return {m.voxel, node->begin[lane], node->comparedPoints(lane)}; }
};

/// A sphere in the frame of a's voxel.
struct Sphere {
  Point center;
  float radius;
};

/// One node of a on its way through b, its children tested all at once.
struct Visit {
  const Node* node = nullptr;
  std::uint32_t leaves = 0; ///< bits of the children that are leaves
  std::uint32_t open = 0;   ///< bits of the children that are not settled yet
  std::uint32_t meeting = 0;
  alignas(32) float x[kLanes], y[kLanes], z[kLanes], r[kLanes]; ///< their spheres in the meeting's frame
  float smallest = 0.0f;                                        ///< of r
  Sphere around;                                                ///< holds them all; in the frame of a's voxel
  Ball ball;                                                    ///< likewise, in the meeting's frame
  std::vector<Candidate> near[kLanes]; ///< what each child has to be compared with; of leaves, in this meeting

  std::uint32_t open_points[kLanes] = {}; ///< of leaves: bits of the points not flagged yet
  std::uint32_t unsure = 0;               ///< bits of leaves that met spheres which were not to be opened
};

class FlagWalk {
public:
  FlagWalk(const FlagQuery& query, const StopRule& rule, std::uint8_t* flags, std::deque<Visit>& visits)
  : a_(query.a),
    b_(query.b),
    pairs_(query.pairs),
    rotation_(query.rotation),
    acceptance_(query.acceptance),
    rule_(rule),
    marked_(query.marked),
    flags_(flags),
    visits_(visits)
  {
  }

  /// Flags the points of one voxel of a.
  void run(std::uint32_t voxel)
  {
    const RelativeFrame above(a_.frame(voxel), a_.pose, b_.frame(kAboveVoxels), b_.pose, rotation_);
    if (rule_.mayStop() && rule_.isSpent(found.work.node_pairs)) {
      found.undecided = true;
      return;
    }
    std::vector<std::uint32_t> reached;
    const bool apart = above.separates(pairs_.clearance + a_.storage.largest_radius + b_.storage.largest_radius);
    if (!apart) ++found.work.volumes_carried; // the voxel's own sphere
    const bool all = !apart && !reach(voxel, above, b_.storage.top[0], reached);
    if (all) return a_.storage.forEachRecord(voxel, [this](std::uint32_t record) { settle(record); });
    if (apart || reached.empty()) {
      if (marked_) a_.storage.forEachRecord(voxel, [this](std::uint32_t record) { flags_[record] = kFree; });
      return;
    }
    if (rule_.mayStop() && !marked_)
      a_.storage.forEachRecord(voxel, [this](std::uint32_t record) { flags_[record] = kUndecided; });
    if (!mayEnter(voxel, reached)) {
      found.undecided = true;
      return;
    }
    a_voxel_ = &a_.voxel(voxel, found.work);

    std::vector<Candidate> candidates;
    for (const std::uint32_t other : reached) {
      const RelativeFrame frame(a_.frame(voxel), a_.pose, b_.frame(other), b_.pose, rotation_);
      const Node& root = b_.voxel(other, found.work).nodes[0];
      for (std::uint32_t lane = 0; lane < root.count; ++lane)
        candidates.push_back(
            {&root, static_cast<std::uint16_t>(lane), 1, static_cast<std::uint32_t>(meetings_.size())});
      meetings_.push_back({&b_.storage.voxels[other], frame, frame.pruneReach(pairs_.clearance),
                           frame.acceptReach(pairs_.clearance), frame.acceptReach(acceptance_.accepted),
                           frame.bluntRadius(), acceptance_.band(frame)});
    }
    descend(a_voxel_->nodes[0], {{0.0f, 0.0f, 0.0f}, a_voxel_->radius}, candidates, 0);
  }

  FlaggedVoxel found;

private:
  /// Whether the walk may go below voxels, and has the time to build those that it needs.
  bool mayEnter(std::uint32_t voxel, const std::vector<std::uint32_t>& reached) const
  {
    if (rule_.deepest == 0 || rule_.isSpent(found.work.node_pairs)) return false;
    if (!rule_.isTimed()) return true;
    std::size_t points = a_.storage.pointsToBuild(voxel);
    for (const std::uint32_t other : reached) points += b_.storage.pointsToBuild(other);
    return rule_.leavesTimeToBuild(points);
  }

  /// Collects the voxels of b that the voxel of a can reach. @return false when all of its points collide.
  bool reach(std::uint32_t voxel, const RelativeFrame& frame, const Node& node, std::vector<std::uint32_t>& reached)
  {
    const float radius = a_.storage.voxels[voxel].radius * frame.stretch_a;
    const Ball ball{frame.g[0], frame.g[1], frame.g[2], radius + frame.pruneReach(pairs_.clearance),
                    frame.acceptReach(acceptance_.accepted) - radius * (1.0f + kSphereMargin)};
    const SphereLanes spheres{node.x, node.y, node.z, node.r, frame.stretch_b};
    found.work.node_pairs += node.count;
    if ((spheresInside(spheres, ball) & firstBits(node.count)) != 0) return false;
    for (std::uint32_t near = spheresNear(spheres, ball, nullptr) & firstBits(node.count); near != 0;
         near &= near - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(near));
      if (node.isLeaf(lane))
        reached.push_back(node.begin[lane]);
      else if (!reach(voxel, frame, b_.storage.top[node.child[lane]], reached))
        return false;
    }
    return true;
  }

  /// Takes a node of a, all its children at once, through its candidates; then its inner children through theirs.
  void descend(const Node& node, const Sphere& around, const std::vector<Candidate>& candidates, std::size_t depth)
  {
    if (rule_.mayStop() && rule_.isSpent(found.work.node_pairs)) {
      found.undecided = true;
      return;
    }
    if (visits_.size() == depth) visits_.emplace_back();
    Visit& visit = visits_[depth];
    begin(visit, node, around);
    for (auto from = candidates.begin(); from != candidates.end() && visit.open != 0;) {
      const auto to =
          std::find_if(from, candidates.end(), [&](const Candidate& c) { return c.meeting != from->meeting; });
      enter(visit, from->meeting);
      for (auto c = from; c != to && visit.open != 0; ++c) settleByPoints(visit, *c);
      for (auto c = from; c != to && visit.open != 0; ++c) take(visit, *c, visit.open);
      compareLeaves(visit);
      from = to;
    }
    if (rule_.mayStop()) clear(visit);
    for (std::uint32_t bits = visit.open & ~visit.leaves; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
      if (visit.near[lane].empty()) continue;
      if (depth + 1 >= rule_.deepest) {
        found.undecided = true;
        continue;
      }
      const Sphere child{{node.x[lane], node.y[lane], node.z[lane]}, node.r[lane]};
      descend(a_voxel_->nodes[node.child[lane]], child, visit.near[lane], depth + 1);
    }
  }

  /// Where flags start as undecided: what has met nothing of b is free.
  void clear(const Visit& visit)
  {
    for (std::uint32_t bits = visit.open; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
      const std::uint32_t begin = visit.node->begin[lane], end = visit.node->begin[lane + 1];
      if ((visit.leaves >> lane & 1) == 0) {
        if (visit.near[lane].empty()) free(begin, end);
      }
      else if ((visit.unsure >> lane & 1) != 0) {
        found.undecided = true;
      }
      else if (visit.node->isCoincident(lane)) {
        free(begin, end);
      }
      else {
        for (std::uint32_t points = visit.open_points[lane]; points != 0; points &= points - 1) {
          const std::uint32_t i = begin + static_cast<std::uint32_t>(std::countr_zero(points));
          free(i, i + 1);
        }
      }
    }
  }

  static void begin(Visit& visit, const Node& node, const Sphere& around)
  {
    visit.unsure = 0;
    visit.around = around;
    visit.node = &node;
    visit.open = firstBits(node.count);
    visit.leaves = 0;
    for (std::uint32_t lane = 0; lane < node.count; ++lane) {
      visit.near[lane].clear();
      if (!node.isLeaf(lane)) continue;
      visit.leaves |= 1u << lane;
      visit.open_points[lane] = firstBits(node.comparedPoints(lane));
    }
  }

  /// Turns to a voxel of b: spheres go to its frame now, points when they are needed.
  void enter(Visit& visit, std::uint32_t meeting)
  {
    visit.meeting = meeting;
    const RelativeFrame& frame = meetings_[meeting].frame;
    carry(frame.m.data(), frame.g.data(), visit.node->x, visit.node->y, visit.node->z, kLanes, visit.x, visit.y,
          visit.z);
    const Point center = carryPoint(frame.m.data(), frame.g.data(), visit.around.center);
    found.work.volumes_carried +=
        visit.node->count + std::uint64_t{1}; // the children's spheres and the one around them
    visit.ball = {center.x, center.y, center.z, visit.around.radius * frame.stretch_a + meetings_[meeting].prune_reach,
                  0.0f};
    visit.smallest = std::numeric_limits<float>::infinity();
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) visit.r[lane] = visit.node->r[lane] * frame.stretch_a;
    for (std::uint32_t lane = 0; lane < visit.node->count; ++lane) {
      visit.smallest = std::min(visit.smallest, visit.r[lane]);
      if ((visit.leaves >> lane & 1) != 0) visit.near[lane].clear();
    }
  }

  /// Compares a sphere of b with those children of the visit that are in `lanes`: settles them, drops it, keeps it for
  /// their own descent, or opens it.
  void take(Visit& visit, const Candidate& candidate, std::uint32_t lanes)
  {
    const Meeting& meeting = meetings_[visit.meeting];
    const Node& node = *candidate.node;
    const std::uint32_t k = candidate.lane;
    const float radius = node.r[k] * meeting.frame.stretch_b;
    const Ball ball{node.x[k], node.y[k], node.z[k], radius + meeting.prune_reach,
                    meeting.accept_reach - radius * (1.0f + kSphereMargin)};
    const SphereLanes spheres{visit.x, visit.y, visit.z, visit.r, 1.0f};
    found.work.node_pairs += static_cast<std::uint64_t>(std::popcount(lanes & visit.open));
    std::uint32_t near = spheresNear(spheres, ball, nullptr) & lanes & visit.open;
    if (near == 0) return;
    if (radius <= meeting.blunt_radius && (near &= ~apartAsGiven(visit, candidate, ball, near)) == 0) return;
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
    const Node& below = meeting.voxel->nodes[node.child[k]];
    const SphereLanes children{below.x, below.y, below.z, below.r, meeting.frame.stretch_b};
    found.work.node_pairs += below.count;
    for (std::uint32_t bits = spheresNear(children, visit.ball, nullptr) & firstBits(below.count); bits != 0;
         bits &= bits - 1) {
      if ((opening & visit.open) == 0) return;
      take(visit, candidate.below(below, static_cast<std::uint32_t>(std::countr_zero(bits))), opening);
    }
  }

  /// Of the children in `near`, those too small for float arithmetic to decide about, whose points as given are apart
  /// from the candidate's.
  std::uint32_t apartAsGiven(const Visit& visit, const Candidate& candidate, const Ball& ball, std::uint32_t near)
  {
    const Meeting& meeting = meetings_[visit.meeting];
    std::uint32_t apart = 0;
    GivenSphere other;
    for (std::uint32_t bits = near; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
      const float dx = visit.x[lane] - ball.x, dy = visit.y[lane] - ball.y, dz = visit.z[lane] - ball.z;
      if (visit.r[lane] > meeting.blunt_radius ||
          !meeting.frame.isUndecided(dx * dx + dy * dy + dz * dz, visit.r[lane] + ball.near_reach))
        continue;
      ++found.work.exact_decisions;
      if (!other.isKnown()) other = givenSphereOf(b_.storage.view, *meeting.voxel, *candidate.node, candidate.lane);
      const GivenSphere own = givenSphereOf(a_.storage.view, *a_voxel_, *visit.node, lane);
      if (areApart(pairs_.distance, own, other, pairs_.clearance)) apart |= 1u << lane;
    }
    return apart;
  }

  /// Where the clearance exceeds the radius of a child, a single point of b near its centre settles all of it.
  void settleByPoints(Visit& visit, const Candidate& candidate)
  {
    const Meeting& meeting = meetings_[visit.meeting];
    if (!(meeting.sure_reach > visit.smallest)) return;
    const Node& node = *candidate.node;
    const std::uint32_t k = candidate.lane;
    // A point of the candidate can be that near only if its sphere comes within the clearance less the child's radius.
    const SphereLanes less_radius{visit.x, visit.y, visit.z, visit.r, -1.0f};
    const Ball ball{node.x[k], node.y[k], node.z[k], node.r[k] * meeting.frame.stretch_b + meeting.sure_reach, 0.0f};
    found.work.node_pairs += static_cast<std::uint64_t>(std::popcount(visit.open));
    for (std::uint32_t bits = spheresNear(less_radius, ball, nullptr) & visit.open; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
      const float reach = meeting.sure_reach - visit.r[lane] * (1.0f + kSphereMargin);
      const Ball center{visit.x[lane], visit.y[lane], visit.z[lane], reach, 0.0f};
      if (reach > 0.0f && hasPointWithin(meeting, candidate, center)) settleChild(visit, lane);
    }
  }

  /// Whether the candidate has a point in the ball; the nearest spheres are asked first.
  bool hasPointWithin(const Meeting& meeting, const Candidate& candidate, const Ball& ball)
  {
    if (candidate.isLeaf()) {
      const LeafRange leaf = candidate.leaf(meeting);
      return anyPointWithin(leaf.x(), leaf.y(), leaf.z(), leaf.count, ball.x, ball.y, ball.z, ball.near_reach);
    }
    const Node& below = meeting.voxel->nodes[candidate.node->child[candidate.lane]];
    float gap[kLanes];
    found.work.node_pairs += below.count;
    std::uint32_t near =
        spheresNear({below.x, below.y, below.z, below.r, meeting.frame.stretch_b}, ball, gap) & firstBits(below.count);
    while (near != 0) {
      auto nearest = static_cast<std::uint32_t>(std::countr_zero(near));
      for (std::uint32_t bits = near & (near - 1); bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
        if (gap[lane] < gap[nearest]) nearest = lane;
      }
      if (hasPointWithin(meeting, candidate.below(below, nearest), ball)) return true;
      near &= ~(1u << nearest);
    }
    return false;
  }

  /// Compares the points of the children that are leaves with the leaves they are near to, in this meeting.
  void compareLeaves(Visit& visit)
  {
    for (std::uint32_t bits = visit.leaves & visit.open; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
      if (visit.near[lane].empty()) continue;
      const LeafRange leaf{a_voxel_, visit.node->begin[lane], visit.node->comparedPoints(lane)};
      LeafPoints points;
      carryLeaf(meetings_[visit.meeting].frame, leaf, points);
      const std::uint32_t hit =
          pairs_.haveRadii() ? hitBalls(visit, lane, leaf, points) : hitPoints(visit, lane, leaf, points);
      for (std::uint32_t set = hit; set != 0; set &= set - 1)
        settle(leaf.record(static_cast<std::uint32_t>(std::countr_zero(set))));
      visit.open_points[lane] &= ~hit;
      if (visit.open_points[lane] == 0) settleChild(visit, lane); // with it whatever its points stand for
    }
  }

  /// Which open points of a leaf collide with the leaves it is near to: by float band, and exactly within the band.
  std::uint32_t hitPoints(const Visit& visit, std::uint32_t lane, const LeafRange& leaf, const LeafPoints& points)
  {
    const Meeting& meeting = meetings_[visit.meeting];
    const std::uint32_t open = visit.open_points[lane];
    alignas(64) float nearest[kLeafPoints];
    std::fill(std::begin(nearest), std::end(nearest), std::numeric_limits<float>::infinity());
    std::uint32_t hit = 0;
    for (const Candidate& candidate : visit.near[lane]) {
      ++found.work.leaf_pairs;
      const LeafRange other = candidate.leaf(meeting);
      // Of neighbouring leaves, only the points that face each other.
      const std::uint32_t facing =
          pointsNear(other.x(), other.y(), other.z(), other.count, visit.x[lane], visit.y[lane], visit.z[lane],
                     visit.r[lane] + meeting.prune_reach, kSphereMargin);
      if (facing == 0) continue;
      nearestSquared(points, other.x(), other.y(), other.z(), facing, nearest);
      hit = open & atMost(nearest, meeting.band.hit);
      if (hit == open) return hit;
    }
    const std::uint32_t undecided = open & ~hit & ~above(nearest, meeting.band.miss);
    for (const Candidate& candidate : visit.near[lane]) {
      if ((undecided & ~hit) == 0) break;
      const LeafRange other = candidate.leaf(meeting);
      eachPairNotBeyond(points, undecided, other, meeting.band.miss, [&](std::uint32_t i, std::uint32_t j, float) {
        if ((hit >> i & 1) == 0 && pairs_.collide({leaf.record(i), other.record(j)}, found.work)) hit |= 1u << i;
        return (undecided & ~hit) == 0;
      });
    }
    return hit;
  }

  /// The same where points have radii.
  std::uint32_t hitBalls(const Visit& visit, std::uint32_t lane, const LeafRange& leaf, const LeafPoints& points)
  {
    const Meeting& meeting = meetings_[visit.meeting];
    const std::uint32_t open = visit.open_points[lane];
    std::uint32_t hit = 0;
    for (const Candidate& candidate : visit.near[lane]) {
      if (hit == open) break;
      ++found.work.leaf_pairs;
      const LeafRange other = candidate.leaf(meeting);
      eachBallPairNear(meeting.frame, points, open, leaf, other, pairs_.clearance,
                       [&](std::uint32_t i, std::uint32_t j, float) {
                         if ((hit >> i & 1) == 0 && pairs_.collide({leaf.record(i), other.record(j)}, found.work))
                           hit |= 1u << i;
                         return hit == open;
                       });
    }
    return hit;
  }

  void settleChild(Visit& visit, std::uint32_t lane)
  {
    visit.open &= ~(1u << lane);
    for (std::uint32_t i = visit.node->begin[lane]; i < visit.node->begin[lane + 1]; ++i)
      settle(a_voxel_->records()[i]);
  }

  void settle(std::uint32_t record)
  {
    found.colliding += flags_[record] != kColliding;
    flags_[record] = kColliding;
  }

  void free(std::uint32_t begin, std::uint32_t end)
  {
    for (std::uint32_t i = begin; i < end; ++i) flags_[a_voxel_->records()[i]] = kFree;
  }

  const Spaces a_, b_;
  const PointPairs& pairs_;
  const RelativeRotation& rotation_;
  const Acceptance& acceptance_;
  const StopRule& rule_;
  const bool marked_;
  std::uint8_t* flags_;
  const Voxel* a_voxel_ = nullptr;
  std::vector<Meeting> meetings_;
  std::deque<Visit>& visits_; // by depth; a deque, for references to shallower visits stay in use
};

/// Appends the voxels below a node above a's voxels that may come near to anything of b, in their order.
void findNearVoxels(const Spaces& a, const Node& others, const RelativeFrame& frame, float reach, const Node& node,
                    std::vector<std::uint32_t>& near, Work& work)
{
  const SphereLanes spheres{others.x, others.y, others.z, others.r, frame.stretch_b};
  work.node_pairs += std::uint64_t{node.count} * others.count;
  work.volumes_carried += node.count;
  for (std::uint32_t lane = 0; lane < node.count; ++lane) {
    const Point center = carriedCenter(frame, node, lane);
    const Ball ball{center.x, center.y, center.z, node.r[lane] * frame.stretch_a + reach, 0.0f};
    if ((spheresNear(spheres, ball, nullptr) & firstBits(others.count)) == 0) continue;
    if (node.isLeaf(lane))
      near.push_back(node.begin[lane]);
    else
      findNearVoxels(a, others, frame, reach, a.storage.top[node.child[lane]], near, work);
  }
}

} // namespace

std::vector<std::uint32_t> nearVoxelsOnTarget(const FlagQuery& query, Work& work)
{
  const Spaces a(query.a), b(query.b);
  const RelativeFrame frame(a.frame(kAboveVoxels), a.pose, b.frame(kAboveVoxels), b.pose, query.rotation);
  std::vector<std::uint32_t> near;
  if (frame.separates(query.pairs.clearance + a.storage.largest_radius + b.storage.largest_radius)) return near;
  findNearVoxels(a, b.storage.top[0], frame, frame.pruneReach(query.pairs.clearance), a.storage.top[0], near, work);
  return near;
}

FlaggedVoxel flagVoxelOnTarget(const FlagQuery& query, const StopRule& rule, std::uint32_t voxel, std::uint8_t* flags)
{
  const ScratchLease<KeptVisits<Visit>> kept;
  FlagWalk walk(query, rule, flags, (*kept).visits);
  walk.run(voxel);
  return walk.found;
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {
namespace {

HWY_EXPORT(flagVoxelOnTarget);
HWY_EXPORT(nearVoxelsOnTarget);

/// The flags of one side, where they are wanted, and what they took.
struct FlagSheet {
  std::vector<std::uint8_t>& flags;
  std::size_t& colliding;
  Work& work;
};

/// Walks the given voxels of a. @return those that were left with undecided points
std::vector<std::uint32_t> flagVoxels(const FlagQuery& query, const StopRule& rule,
                                      const std::vector<std::uint32_t>& voxels, unsigned threads,
                                      const FlagSheet& sheet)
{
  std::vector<FlaggedVoxel> parts(voxels.size());
  const auto flag = [&](std::size_t i, const StopRule& own) {
    parts[i] = HWY_DYNAMIC_DISPATCH(flagVoxelOnTarget)(query, own, voxels[i], sheet.flags.data());
  };
  if (rule.node_pairs == StopRule::kNever) {
    parallelFor(voxels.size(), threads, [&](std::size_t i) { flag(i, rule); });
  }
  else { // one after another: what one leaves is the next one's
    StopRule own = rule;
    for (std::size_t i = 0; i < voxels.size(); ++i) {
      flag(i, own);
      own.node_pairs -= std::min(own.node_pairs, parts[i].work.node_pairs);
    }
  }
  std::vector<std::uint32_t> left;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    sheet.work += parts[i].work;
    sheet.colliding += parts[i].colliding;
    if (parts[i].undecided) left.push_back(voxels[i]);
  }
  return left;
}

/// All that the hierarchy holds is undecided.
void markUndecided(const SphereHierarchy& hierarchy, std::vector<std::uint8_t>& flags)
{
  if (hierarchy.size() == flags.size()) {
    std::fill(flags.begin(), flags.end(), kUndecided);
    return;
  }
  for (std::size_t v = 0; v < hierarchy.storage().voxel_count; ++v)
    hierarchy.storage().forEachRecord(v, [&](std::uint32_t record) { flags[record] = kUndecided; });
}

/// The flags of one cloud.
class FlagSide {
public:
  FlagSide(const Placed& a, const Placed& b, const FlagsRequest& request, const StopRule& rule, const FlagSheet& sheet)
  : sheet_(sheet),
    pairs_(a, b, request.clearance),
    // A budget may end before a voxel is looked at. A level looks at all, and has to mark only those that come near.
    query_{a,
           b,
           pairs_,
           RelativeRotation(a.pose, b.pose),
           Acceptance(request.clearance, request.accuracy),
           rule.mayStop() && rule.deepest == StopRule::kNever},
    threads_(threadCount(request.threads))
  {
    sheet_.flags.assign(a.hierarchy().view().count, kFree);
    if (a.hierarchy().empty() || b.hierarchy().empty()) return;
    if (query_.marked) {
      voxels_.resize(a.hierarchy().storage().voxel_count);
      std::iota(voxels_.begin(), voxels_.end(), 0u);
      markUndecided(a.hierarchy(), sheet_.flags);
    }
    else { // what is not near is free, as flags are at first
      voxels_ = HWY_DYNAMIC_DISPATCH(nearVoxelsOnTarget)(query_, sheet_.work);
    }
  }

  /// Whether every point is decided.
  bool done() const { return voxels_.empty(); }

  /// Sphere tests of all passes so far.
  std::uint64_t spent() const { return spent_; }

  /// Walks what was left undecided. The rule's sphere tests are for this pass.
  void pass(const StopRule& rule)
  {
    if (done()) return;
    Work work;
    std::vector<std::uint32_t> left =
        flagVoxels(query_, rule, voxels_, threads_, {sheet_.flags, sheet_.colliding, work});
    voxels_ = rule.mayStop() ? std::move(left) : std::vector<std::uint32_t>();
    sheet_.work += work;
    spent_ += work.node_pairs;
  }

  /// All passes of a rule. @param tests for all of them, those already spent among them
  void passes(StopRule rule, std::uint64_t tests)
  {
    if (!rule.mayStop()) return pass(rule);
    for (const std::uint64_t deepest : rule.passes()) {
      rule.deepest = deepest;
      if (tests != StopRule::kNever) rule.node_pairs = tests - std::min(tests, spent_);
      pass(rule);
    }
  }

private:
  const FlagSheet sheet_;
  const PointPairs pairs_;
  const FlagQuery query_;
  const unsigned threads_;
  std::vector<std::uint32_t> voxels_; // with undecided points
  std::uint64_t spent_ = 0;
};

/// Both clouds share the budget: each has half of it, and what one leaves is the other's.
void flagBoth(FlagSide& a, FlagSide& b, const StopRule& rule)
{
  const StopRule half = rule.part(0.5);
  a.passes(half, half.node_pairs);
  // Of a count of tests, b gets more than half only when a is done: then a is done with any larger count as well, and
  // whatever a count decides, a larger one decides.
  const std::uint64_t left = rule.node_pairs - std::min(rule.node_pairs, a.spent());
  b.passes(rule, rule.node_pairs == StopRule::kNever || !a.done() ? half.node_pairs : std::max(half.node_pairs, left));
  if (rule.isTimed()) a.passes(rule, StopRule::kNever);
}

std::size_t countUndecided(const std::vector<std::uint8_t>& flags)
{
  return static_cast<std::size_t>(std::count(flags.begin(), flags.end(), kUndecided));
}

} // namespace

void collisionFlags(const Placed& a, const Placed& b, const FlagsRequest& request, FlagsResult& result)
{
  check(a, b, request);
  const DefaultFloatEnvironment environment;
  FlagsResult found;
  found.a.swap(result.a);
  found.b.swap(result.b);
  result = FlagsResult(); // whatever throws, it tells of no collision, and of no free point either
  found.a.clear();
  found.b.clear();
  const StopRule rule(request.accuracy);
  std::optional<FlagSide> of_a, of_b;
  if (request.flagged != Side::b) of_a.emplace(a, b, request, rule, FlagSheet{found.a, found.colliding_a, found.work});
  if (request.flagged != Side::a) of_b.emplace(b, a, request, rule, FlagSheet{found.b, found.colliding_b, found.work});
  if (of_a && of_b && rule.mayStop())
    flagBoth(*of_a, *of_b, rule);
  else {
    if (of_a) of_a->passes(rule, rule.node_pairs);
    if (of_b) of_b->passes(rule, rule.node_pairs);
  }
  if (request.accuracy.stopsEarly()) {
    found.undecided_a = countUndecided(found.a);
    found.undecided_b = countUndecided(found.b);
  }
  result = std::move(found);
}

FlagsResult collisionFlags(const Placed& a, const Placed& b, const FlagsRequest& request)
{
  FlagsResult result;
  collisionFlags(a, b, request, result);
  return result;
}

} // namespace pcl_bsh
#endif
