// SPDX-License-Identifier: BSD-3-Clause
// Flags: every node of a carries the list of what can still matter of b, so that a's points share one descent. A point
// is settled at its first neighbour, a node as soon as its farthest point must be within the clearance of something.
#include <pcl_bsh/hierarchy/parallel.h>
#include <pcl_bsh/query/collide.h>
#include <pcl_bsh/query/request_check.h>

#include <algorithm>
#include <numeric>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/query/collision_flags.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/query/leaf_pair-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {
namespace {

/// A ball of a in the frame of some space of b: a child of the walk, with what it has to be compared with.
struct Ball {
  float x, y, z;
  float near_reach;   ///< its radius and the clearance, outward
  float inside_reach; ///< the clearance less its radius, inward
};

/// Spheres of b, all in the frame of one voxel, that the points of some node of a may collide with.
class Candidates {
public:
  void clear() { count = 0; }

  void add(const Node& node, std::uint32_t lane, float stretch)
  {
    if (count + kLanes >= x_.size()) resize(2 * count + 4 * kLanes);
    x_[count] = node.x[lane], y_[count] = node.y[lane], z_[count] = node.z[lane];
    r_[count] = node.r[lane] * stretch;
    node_[count] = &node;
    lane_[count] = lane;
    ++count;
  }

  void add(const Candidates& other, std::size_t i)
  {
    if (count + kLanes >= x_.size()) resize(2 * count + 4 * kLanes);
    x_[count] = other.x_[i], y_[count] = other.y_[i], z_[count] = other.z_[i], r_[count] = other.r_[i];
    node_[count] = other.node_[i];
    lane_[count] = other.lane_[i];
    ++count;
  }

  /// Tests eight from `first` on.
  SphereHits test(std::size_t first, const Ball& ball) const
  {
    float gap[kLanes];
    SphereHits hits = testSpheres(&x_[first], &y_[first], &z_[first], &r_[first], 1.0f, ball.x, ball.y, ball.z,
                                  ball.near_reach, ball.inside_reach, kPruneMargin, gap);
    const std::uint32_t used = firstBits(std::min(kLanes, count - first));
    hits.near &= used;
    hits.inside &= used;
    return hits;
  }

  const Node& node(std::size_t i) const { return *node_[i]; }
  std::uint32_t lane(std::size_t i) const { return lane_[i]; }
  bool isLeaf(std::size_t i) const { return node_[i]->isLeaf(lane_[i]); }
  float radius(std::size_t i) const { return r_[i]; }

  std::size_t count = 0;

private:
  void resize(std::size_t size)
  {
    x_.resize(size), y_.resize(size), z_.resize(size), r_.resize(size);
    node_.resize(size);
    lane_.resize(size);
  }

  std::vector<float> x_, y_, z_, r_;
  std::vector<const Node*> node_;
  std::vector<std::uint32_t> lane_;
};

/// The candidates of one voxel of b.
struct Group {
  const Voxel* voxel = nullptr;
  const RelativeFrame* frame = nullptr;
  float prune_reach = 0.0f, accept_reach = 0.0f;
  DistanceBand band;
  Candidates candidates;
};

class FlagWalk {
public:
  FlagWalk(const Placed& a, const Placed& b, const PointPairs& pairs, std::uint8_t* flags)
  : a_(a),
    b_(b),
    pairs_(pairs),
    flags_(flags)
  {
  }

  /// Flags the points of one voxel of a.
  void run(std::uint32_t voxel)
  {
    const RelativeFrame above(a_.frame(voxel), a_.pose, b_.frame(kAboveVoxels), b_.pose);
    if (above.separates(pairs_.clearance)) return;
    std::vector<std::uint32_t> reached;
    if (!reach(voxel, above, 0, reached)) {
      const Voxel& built = a_.voxel(voxel, work);
      return settle(built, 0, built.count);
    }
    if (reached.empty()) return;
    a_built_ = &a_.voxel(voxel, work);
    std::vector<RelativeFrame> frames;
    frames.reserve(reached.size());
    std::vector<Group>& groups = level(0);
    groups.clear();
    for (const std::uint32_t other : reached) {
      frames.emplace_back(a_.frame(voxel), a_.pose, b_.frame(other), b_.pose);
      Group& group = groups.emplace_back();
      group.voxel = &b_.voxel(other, work);
      group.frame = &frames.back();
      group.prune_reach = frames.back().pruneReach(pairs_.clearance);
      group.accept_reach = frames.back().acceptReach(pairs_.clearance);
      group.band = frames.back().band(pairs_.clearance);
      const Node& root = group.voxel->nodes[0];
      for (std::uint32_t lane = 0; lane < root.count; ++lane) group.candidates.add(root, lane, group.frame->stretch_b);
    }
    descend(a_built_->nodes[0], 0);
  }

  Work work;

private:
  // Half the size settles nodes sooner, for it costs less than the children of a would.
  static constexpr float kOpened = 1.0f; ///< candidates larger than this times the ball of a are opened

  std::vector<Group>& level(std::size_t depth)
  {
    while (levels_.size() <= depth) levels_.emplace_back();
    return levels_[depth];
  }

  /// Collects the voxels of b that the voxel of a can reach. @return false when all of its points collide.
  bool reach(std::uint32_t voxel, const RelativeFrame& frame, std::uint32_t node_index,
             std::vector<std::uint32_t>& reached)
  {
    const Node& node = b_.storage.top[node_index];
    const Ball ball = ballOf(voxel, frame);
    float gap[kLanes];
    SphereHits hits = testSpheres(node.x, node.y, node.z, node.r, frame.stretch_b, ball.x, ball.y, ball.z,
                                  ball.near_reach, ball.inside_reach, kPruneMargin, gap);
    work.node_pairs += node.count;
    const std::uint32_t used = firstBits(node.count);
    if ((hits.inside & used) != 0) return false;
    for (std::uint32_t near = hits.near & used; near != 0; near &= near - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(near));
      if (node.isLeaf(lane))
        reached.push_back(node.begin[lane]);
      else if (!reach(voxel, frame, node.child[lane], reached))
        return false;
    }
    return true;
  }

  /// The ball around all of a voxel's points, in the frame above b's voxels.
  Ball ballOf(std::uint32_t voxel, const RelativeFrame& frame) const
  {
    const float radius = a_.storage.voxels[voxel].radius * frame.stretch_a;
    return {frame.g[0], frame.g[1], frame.g[2], radius + frame.pruneReach(pairs_.clearance),
            frame.acceptReach(pairs_.clearance) - radius * (1.0f + kPruneMargin)};
  }

  /// Takes every child of a's node through what is left of b.
  void descend(const Node& node, std::size_t depth)
  {
    level(depth + 1);
    for (std::uint32_t lane = 0; lane < node.count; ++lane) {
      if (!filter(node, lane, depth)) {
        settle(*a_built_, node.begin[lane], node.begin[lane + 1]);
        continue;
      }
      if (level(depth + 1).empty() || level_counts_[depth + 1] == 0) continue;
      if (node.isLeaf(lane))
        compareLeaf(node, lane, depth + 1);
      else
        descend(a_built_->nodes[node.child[lane]], depth + 1);
    }
  }

  /// Narrows the candidates at `depth` to those near the child, opened down to its size, at depth + 1.
  /// @return false when all points of the child collide.
  bool filter(const Node& node, std::uint32_t lane, std::size_t depth)
  {
    level_counts_.resize(std::max(level_counts_.size(), depth + 2));
    std::vector<Group>& from = level(depth);
    const std::size_t from_count = depth == 0 ? from.size() : level_counts_[depth];
    std::vector<Group>& to = level(depth + 1);
    std::size_t used = 0;
    for (std::size_t g = 0; g < from_count; ++g) {
      const Group& group = from[g];
      if (to.size() == used) to.emplace_back();
      Group& narrowed = to[used];
      narrowed.candidates.clear();
      const Ball ball = ballOf(node, lane, group);
      const float opened_above = node.isLeaf(lane) ? 0.0f : kOpened * node.r[lane] * group.frame->stretch_a;
      work.node_pairs += group.candidates.count;
      for (std::size_t i = 0; i < group.candidates.count; i += kLanes) {
        const SphereHits hits = group.candidates.test(i, ball);
        if (hits.inside != 0) return false;
        for (std::uint32_t near = hits.near; near != 0; near &= near - 1)
          if (!open(group, group.candidates, i + static_cast<std::size_t>(std::countr_zero(near)), ball, opened_above,
                    narrowed.candidates))
            return false;
      }
      if (narrowed.candidates.count == 0) continue;
      narrowed.voxel = group.voxel;
      narrowed.frame = group.frame;
      narrowed.prune_reach = group.prune_reach;
      narrowed.accept_reach = group.accept_reach;
      narrowed.band = group.band;
      ++used;
    }
    level_counts_[depth + 1] = used;
    return true;
  }

  Ball ballOf(const Node& node, std::uint32_t lane, const Group& group) const
  {
    const RelativeFrame& f = *group.frame;
    const float px = node.x[lane], py = node.y[lane], pz = node.z[lane];
    const float radius = node.r[lane] * f.stretch_a;
    return {((f.g[0] + f.m[0] * px) + f.m[1] * py) + f.m[2] * pz, ((f.g[1] + f.m[3] * px) + f.m[4] * py) + f.m[5] * pz,
            ((f.g[2] + f.m[6] * px) + f.m[7] * py) + f.m[8] * pz, radius + group.prune_reach,
            group.accept_reach - radius * (1.0f + kPruneMargin)};
  }

  bool open(const Group& group, const Candidates& list, std::size_t i, const Ball& ball, float opened_above,
            Candidates& out)
  {
    if (list.isLeaf(i) || list.radius(i) <= opened_above) {
      out.add(list, i);
      return true;
    }
    return openNode(group, group.voxel->nodes[list.node(i).child[list.lane(i)]], ball, opened_above, out);
  }

  bool openNode(const Group& group, const Node& node, const Ball& ball, float opened_above, Candidates& out)
  {
    float gap[kLanes];
    const float stretch = group.frame->stretch_b;
    SphereHits hits = testSpheres(node.x, node.y, node.z, node.r, stretch, ball.x, ball.y, ball.z, ball.near_reach,
                                  ball.inside_reach, kPruneMargin, gap);
    work.node_pairs += node.count;
    const std::uint32_t used = firstBits(node.count);
    if ((hits.inside & used) != 0) return false;
    for (std::uint32_t near = hits.near & used; near != 0; near &= near - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(near));
      if (node.isLeaf(lane) || node.r[lane] * stretch <= opened_above)
        out.add(node, lane, stretch);
      else if (!openNode(group, group.voxel->nodes[node.child[lane]], ball, opened_above, out))
        return false;
    }
    return true;
  }

  /// The points of a's leaf against the leaves of b that are left.
  void compareLeaf(const Node& node, std::uint32_t lane, std::size_t depth)
  {
    const LeafRange leaf = leafOf(a_, static_cast<std::uint32_t>(a_built_ - a_.storage.voxels.get()), node, lane);
    std::uint32_t open_points = firstBits(leaf.count);
    const std::vector<Group>& groups = level(depth);
    for (std::size_t g = 0; g < level_counts_[depth] && open_points != 0; ++g) {
      const std::uint32_t hit =
          pairs_.haveRadii() ? hitBalls(groups[g], leaf, open_points) : hitPoints(groups[g], leaf, open_points);
      for (std::uint32_t bits = hit; bits != 0; bits &= bits - 1)
        flags_[leaf.record(static_cast<std::uint32_t>(std::countr_zero(bits)))] = 1;
      open_points &= ~hit;
    }
  }

  /// Which of the leaf's open points collide with the group's candidates, all of them leaves.
  std::uint32_t hitPoints(const Group& group, const LeafRange& leaf, std::uint32_t open_points)
  {
    LeafPoints points;
    carryLeaf(*group.frame, leaf, points);
    alignas(64) float nearest[kLeafPoints];
    std::fill(std::begin(nearest), std::end(nearest), std::numeric_limits<float>::infinity());
    std::uint32_t hit = 0;
    for (std::size_t i = 0; i < group.candidates.count; ++i) {
      ++work.leaf_pairs;
      const LeafRange other = leafOfCandidate(group, i);
      nearestSquared(points, other.x(), other.y(), other.z(), other.count, nearest);
      hit = open_points & atMost(nearest, group.band.hit);
      if (hit == open_points) return hit;
    }
    std::uint32_t undecided = open_points & ~hit & ~above(nearest, group.band.miss);
    for (std::size_t i = 0; i < group.candidates.count && undecided != 0; ++i) {
      const LeafRange other = leafOfCandidate(group, i);
      eachPairNotBeyond(points, undecided, other, group.band.miss, [&](std::uint32_t p, std::uint32_t q, float) {
        if ((undecided >> p & 1) != 0 && pairs_.collide({leaf.record(p), other.record(q)}, work)) {
          hit |= 1u << p;
          undecided &= ~(1u << p);
        }
        return undecided == 0;
      });
    }
    return hit;
  }

  /// The same where points have radii.
  std::uint32_t hitBalls(const Group& group, const LeafRange& leaf, std::uint32_t open_points)
  {
    LeafPoints points;
    carryLeaf(*group.frame, leaf, points);
    std::uint32_t hit = 0;
    for (std::size_t i = 0; i < group.candidates.count && hit != open_points; ++i) {
      ++work.leaf_pairs;
      const LeafRange other = leafOfCandidate(group, i);
      eachBallPairNear(*group.frame, points, open_points, leaf, other, pairs_.clearance,
                       [&](std::uint32_t p, std::uint32_t q, float) {
                         if ((hit >> p & 1) == 0 && pairs_.collide({leaf.record(p), other.record(q)}, work))
                           hit |= 1u << p;
                         return hit == open_points;
                       });
    }
    return hit;
  }

  static LeafRange leafOfCandidate(const Group& group, std::size_t i)
  {
    const Node& node = group.candidates.node(i);
    const std::uint32_t lane = group.candidates.lane(i);
    return {group.voxel, node.begin[lane], node.points(lane)};
  }

  void settle(const Voxel& voxel, std::uint32_t begin, std::uint32_t end)
  {
    for (std::uint32_t i = begin; i < end; ++i) flags_[voxel.records()[i]] = 1;
  }

  Spaces a_, b_;
  const PointPairs& pairs_;
  std::uint8_t* flags_;
  const Voxel* a_built_ = nullptr;
  std::deque<std::vector<Group>> levels_; // of candidates, one for each depth of a's node; groups keep their storage
  std::vector<std::size_t> level_counts_; // groups in use
};

} // namespace

Work flagVoxelOnTarget(const Placed& a, const Placed& b, const PointPairs& pairs, std::uint32_t voxel,
                       std::uint8_t* flags)
{
  FlagWalk walk(a, b, pairs, flags);
  walk.run(voxel);
  return walk.work;
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {
namespace {

HWY_EXPORT(flagVoxelOnTarget);

std::vector<std::uint8_t> flagsOf(const Placed& a, const Placed& b, const CollisionRequest& request, Work& work)
{
  std::vector<std::uint8_t> flags(a.hierarchy.view().count, 0);
  if (a.hierarchy.empty() || b.hierarchy.empty()) return flags;
  const PointPairs pairs(a, b, request.clearance);
  const std::size_t voxels = a.hierarchy.storage().voxel_count;
  std::vector<Work> parts(voxels);
  parallelFor(voxels, threadCount(request.threads), [&](std::size_t v) {
    parts[v] = HWY_DYNAMIC_DISPATCH(flagVoxelOnTarget)(a, b, pairs, static_cast<std::uint32_t>(v), flags.data());
  });
  for (const Work& part : parts) work += part;
  return flags;
}

std::size_t countSet(const std::vector<std::uint8_t>& flags)
{
  return static_cast<std::size_t>(std::count(flags.begin(), flags.end(), std::uint8_t{1}));
}

} // namespace

FlagsResult collisionFlags(const Placed& a, const Placed& b, const CollisionRequest& request)
{
  check(a, b, request);
  FlagsResult result;
  if (request.flagged != Side::b) result.a = flagsOf(a, b, request, result.work);
  if (request.flagged != Side::a) result.b = flagsOf(b, a, request, result.work);
  result.colliding_a = countSet(result.a);
  result.colliding_b = countSet(result.b);
  return result;
}

} // namespace pcl_bsh
#endif
