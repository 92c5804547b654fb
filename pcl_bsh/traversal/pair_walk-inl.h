// SPDX-License-Identifier: BSD-3-Clause
// One step of the simultaneous descent of two hierarchies, for queries that look for one pair of points: opens the
// larger sphere of a pair and tests its children against the other sphere. The query keeps the pairs and chooses their
// order.

#if defined(PCL_BSH_TRAVERSAL_PAIR_WALK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAVERSAL_PAIR_WALK_INL_H_
#undef PCL_BSH_TRAVERSAL_PAIR_WALK_INL_H_
#else
#define PCL_BSH_TRAVERSAL_PAIR_WALK_INL_H_
#endif

#include <pcl_bsh/hierarchy/build/crowded_cell.h>
#include <pcl_bsh/traversal/far_points-inl.h>
#include <pcl_bsh/traversal/space.h>

#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

/// A child of some node: where its sphere is stored.
struct Lane {
  std::uint32_t space = kAboveVoxels;
  std::uint32_t node = 0;
  std::uint32_t lane = 0;
};

/// Two lanes that may meet, and how near they are: smaller is nearer.
struct LanePair {
  float key = 0.0f;
  Lane a, b;
};

/// Memory of one search's stack after another, to be had by a ScratchLease.
struct PairStack {
  std::vector<LanePair> pairs;
  std::size_t bytes() const noexcept { return pairs.capacity() * sizeof(LanePair); }
};

/// Whose children to look at next.
enum class Opened : std::uint8_t { a, b, neither };

/// Orders the pairs from `from` on so that the nearest is last, to be taken first. Insertion keeps the order of equals,
/// and a step adds eight at most.
inline void nearestLast(std::vector<LanePair>& stack, std::size_t from)
{
  for (std::size_t i = from + 1; i < stack.size(); ++i) {
    const LanePair pair = stack[i];
    std::size_t k = i;
    for (; k > from && stack[k - 1].key < pair.key; --k) stack[k] = stack[k - 1];
    stack[k] = pair;
  }
}

class PairWalk {
public:
  PairWalk(const Placed& placed_a, const Placed& placed_b)
  : a(placed_a),
    b(placed_b),
    frames(a, b),
    distance(placed_a.pose, placed_b.pose)
  {
  }

  Spaces a, b;
  FrameTable frames;
  ExactDistance distance;
  Work work;
  double accepted_beyond = 0.0; ///< pairs at this much more than the clearance may count as colliding, too;
                                ///< below 0 only those that are as much nearer

  const Node& nodeOf(const Spaces& side, const Lane& lane) const { return side.node(lane.space, lane.node); }

  bool isLeaf(const Spaces& side, const Lane& lane) const
  {
    return lane.space != kAboveVoxels && nodeOf(side, lane).isLeaf(lane.lane);
  }

  LeafRange leaf(const Spaces& side, const Lane& lane) const
  {
    return leafOf(side, lane.space, nodeOf(side, lane), lane.lane);
  }

  /// The larger one, in the clouds' unit, unless it is a leaf.
  Opened choose(const LanePair& pair) const
  {
    const bool leaf_a = isLeaf(a, pair.a), leaf_b = isLeaf(b, pair.b);
    if (leaf_a && leaf_b) return Opened::neither;
    if (leaf_a != leaf_b) return leaf_a ? Opened::b : Opened::a;
    const double ra = nodeOf(a, pair.a).r[pair.a.lane] * a.frame(pair.a.space).unit;
    const double rb = nodeOf(b, pair.b).r[pair.b.lane] * b.frame(pair.b.space).unit;
    return ra > rb ? Opened::a : Opened::b;
  }

  /// The node below a lane that is not a leaf. Entering a voxel builds it.
  Lane enter(const Spaces& side, const Lane& lane)
  {
    const Node& node = nodeOf(side, lane);
    if (!node.isLeaf(lane.lane)) return {lane.space, node.child[lane.lane], 0};
    side.voxel(node.begin[lane.lane], work);
    return {node.begin[lane.lane], 0, 0};
  }

  /// The children that a step has found near, as bits, with the sphere test's figures.
  struct Step {
    Lane entered;             ///< the node whose children were tested
    std::uint32_t near = 0;   ///< bit i: child i is not proven to be apart
    std::uint32_t inside = 0; ///< bit i: all its points collide with all points of the other side
    float gap[kLanes];        ///< from the other sphere's centre to each child, by spheresNear()
    const RelativeFrame* frame = nullptr;
    const float* radii = nullptr; ///< of the children
    float stretch = 1.0f;         ///< of the children's radii
    float radius = 0.0f;          ///< of the other sphere, stretched
    float reach = 0.0f;           ///< what is farther apart than this does not collide
  };

  /// Tests the children of pair.a, once opened, against pair.b; or the other way round.
  void step(const LanePair& pair, Opened opened, double clearance, Step& out)
  {
    if (opened == Opened::a)
      testChildrenOfA(enter(a, pair.a), pair.b, clearance, out);
    else
      testChildrenOfB(pair.a, enter(b, pair.b), clearance, out);
    const bool is_larger = out.radius > kLargeLeaf * out.radii[0] * out.stretch;
    const bool is_blunt = out.radius <= out.frame->bluntRadius();
    if (HWY_UNLIKELY(is_larger || is_blunt || mayBeFar(out.reach, out.radius)) && out.near != 0)
      lookAgain(pair, opened, clearance, out);
  }

  void testChildrenOfA(const Lane& entered, const Lane& lane_b, double clearance, Step& out)
  {
    const RelativeFrame& frame = frames.find(entered.space, lane_b.space);
    const Node& node = nodeOf(a, entered);
    const Node& other = nodeOf(b, lane_b);
    alignas(32) float x[kLanes], y[kLanes], z[kLanes];
    carry(frame.m.data(), frame.g.data(), node.x, node.y, node.z, kLanes, x, y, z);
    work.volumes_carried += node.count;
    out.entered = entered;
    const SphereLanes spheres{x, y, z, node.r, frame.stretch_a};
    const Point center{other.x[lane_b.lane], other.y[lane_b.lane], other.z[lane_b.lane]};
    test(frame, spheres, node.count, center, other.r[lane_b.lane] * frame.stretch_b, clearance, out);
    if (out.near == 0 || !haveSlabs(entered, lane_b)) return;
    const Slabs &own = slabsOf(a, entered), &others = slabsOf(b, lane_b);
    alignas(32) float nx[kLanes], ny[kLanes], nz[kLanes];
    constexpr float nowhere[3] = {0.0f, 0.0f, 0.0f};
    carry(frame.m.data(), nowhere, own.x, own.y, own.z, kLanes, nx, ny, nz);
    const Slab other_slab{{others.x[lane_b.lane], others.y[lane_b.lane], others.z[lane_b.lane]},
                          others.h[lane_b.lane],
                          center,
                          out.radius};
    out.near &= ~slabsApart(spheres, {nx, ny, nz, own.h}, other_slab, out.reach);
  }

  void testChildrenOfB(const Lane& lane_a, const Lane& entered, double clearance, Step& out)
  {
    const RelativeFrame& frame = frames.find(lane_a.space, entered.space);
    const Node& node = nodeOf(b, entered);
    const Node& other = nodeOf(a, lane_a);
    out.entered = entered;
    const SphereLanes spheres{node.x, node.y, node.z, node.r, frame.stretch_b};
    const Point center = carriedCenter(frame, other, lane_a.lane);
    ++work.volumes_carried;
    test(frame, spheres, node.count, center, other.r[lane_a.lane] * frame.stretch_a, clearance, out);
    if (out.near == 0 || !haveSlabs(lane_a, entered)) return;
    const Slabs &own = slabsOf(b, entered), &others = slabsOf(a, lane_a);
    constexpr float nowhere[3] = {0.0f, 0.0f, 0.0f};
    const Point normal =
        carryPoint(frame.m.data(), nowhere, {others.x[lane_a.lane], others.y[lane_a.lane], others.z[lane_a.lane]});
    const Slab other_slab{normal, others.h[lane_a.lane], center, out.radius};
    out.near &= ~slabsApart(spheres, {own.x, own.y, own.z, own.h}, other_slab, out.reach);
  }

  /// Calls push(pair, step, lane) for every pair of children of the two roots that may meet.
  template <class Push>
  void seed(double clearance, const Push& push)
  {
    if (a.storage.size == 0 || b.storage.size == 0) return;
    const double reach = clearance + a.storage.largest_radius + b.storage.largest_radius;
    if (frames.find(kAboveVoxels, kAboveVoxels).separates(reach)) return;
    Step found;
    for (std::uint32_t i = 0; i < a.storage.top[0].count; ++i) {
      const LanePair pair{0.0f, {kAboveVoxels, 0, i}, {kAboveVoxels, 0, 0}};
      testChildrenOfB(pair.a, pair.b, clearance, found);
      for (std::uint32_t near = found.near; near != 0; near &= near - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(near));
        push(childOf(pair, Opened::b, found, lane), found, lane);
      }
    }
  }

  static LanePair childOf(const LanePair& pair, Opened opened, const Step& step, std::uint32_t lane)
  {
    LanePair child = pair;
    (opened == Opened::a ? child.a : child.b) = {step.entered.space, step.entered.node, lane};
    child.key = step.gap[lane];
    return child;
  }

  /// No pair of points below child `lane` of a step is nearer than this, in the clouds' unit; may be negative.
  /// @param pair the child, as childOf() has it: the pair that was opened may be in a space of another unit
  double lowerBound(const LanePair& pair, const Step& step, std::uint32_t lane) const
  {
    const double gap = step.gap[lane], radius = step.radii[lane] * step.stretch;
    const double rounding = static_cast<double>(kSphereMargin) * (std::abs(gap) + 2 * radius + step.radius);
    const double bound =
        gap - rounding - static_cast<double>(step.radius) - static_cast<double>(step.frame->pruneReach(0.0));
    const double stored = (bound - std::abs(bound) * step.frame->skew()) * b.frame(pair.b.space).unit;
    if (!isBlunt(pair, step, lane)) return stored;
    const GivenSphere given_a = givenSphere(a, pair.a), given_b = givenSphere(b, pair.b);
    const double given = distance.enclose(given_a.center, given_b.center).low -
                         (given_a.radius + given_b.radius) * (1.0 + 2 * kPoseStretch);
    return std::isfinite(given) ? std::max(stored, given) : stored;
  }

private:
  /// What spheres say least about: nodes as small as the float error, leaves large beside the other node, and nodes far
  /// from each other for their size.
  HWY_NOINLINE void lookAgain(const LanePair& pair, Opened opened, double clearance, Step& out)
  {
    if (out.radius <= out.frame->bluntRadius()) dropApartAsGiven(pair, opened, clearance, out);
    const bool is_larger = out.radius > kLargeLeaf * out.radii[0] * out.stretch;
    if (is_larger && out.near != 0 && leafIsApart(pair, opened, clearance)) out.near = 0;
    if (out.near != 0 && mayBeFar(out.reach, out.radius)) dropFarApart(pair, opened, clearance, out);
  }

  /// Whether the other side of a pair is a leaf much larger than what was opened, and none of its points is near that.
  /// Such a leaf's sphere tells nothing: in a shell about a tiny ball, each leaf would be compared with all of the
  /// ball. (What is not a leaf is opened before what is smaller.)
  bool leafIsApart(const LanePair& pair, Opened opened, double clearance)
  {
    const bool leaf_is_a = opened == Opened::b;
    const double ra = nodeOf(a, pair.a).r[pair.a.lane] * a.frame(pair.a.space).unit;
    const double rb = nodeOf(b, pair.b).r[pair.b.lane] * b.frame(pair.b.space).unit;
    if (!(leaf_is_a ? ra > kLargeLeaf * rb : rb > kLargeLeaf * ra)) return false;
    const RelativeFrame& frame = frames.find(pair.a.space, pair.b.space);
    const LeafRange points = leaf_is_a ? leaf(a, pair.a) : leaf(b, pair.b);
    work.node_pairs += points.count;
    if (leaf_is_a) {
      LeafPoints places;
      carryLeaf(frame, points, places);
      return pointsNearLeaf(frame, places, points, nodeOf(b, pair.b), pair.b.lane, clearance) == 0;
    }
    const Node& node = nodeOf(a, pair.a);
    const Point center = carriedCenter(frame, node, pair.a.lane);
    const float reach = node.r[pair.a.lane] * frame.stretch_a + frame.pruneReach(clearance + points.largestRadius());
    return pointsNear(points.x(), points.y(), points.z(), points.count, center.x, center.y, center.z, reach,
                      kSphereMargin) == 0;
  }

  /// Whether slabs can be compared: in voxels of the same unit, where points have no radii.
  bool haveSlabs(const Lane& lane_a, const Lane& lane_b) const
  {
    return lane_a.space != kAboveVoxels && lane_b.space != kAboveVoxels && !a.storage.view.radii &&
           !b.storage.view.radii && a.frame(lane_a.space).unit == b.frame(lane_b.space).unit;
  }

  const Slabs& slabsOf(const Spaces& side, const Lane& lane)
  {
    Voxel& voxel = side.storage.voxels[lane.space];
    return voxel.slabs.of(voxel, work)[lane.node];
  }

  NodeSupport supportOf(const Spaces& side, const Lane& lane)
  {
    Voxel& voxel = side.storage.voxels[lane.space];
    return nodeSupport(voxel, voxel.nodes[lane.node], lane.lane, work);
  }

  /// Removes children from the step's `near` that are far from the other node for their size, and apart from it.
  void dropFarApart(const LanePair& pair, Opened opened, double clearance, Step& out)
  {
    std::uint32_t far = out.near & spheresFar(out.gap, out.radii, out.stretch, out.radius, kFarNodes);
    const LanePair first = childOf(pair, opened, out, 0);
    if (far == 0 || !std::isfinite(clearance) || !haveSlabs(first.a, first.b)) return;
    const NodeSupport other = opened == Opened::a ? supportOf(b, pair.b) : supportOf(a, pair.a);
    for (; far != 0; far &= far - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(far));
      const LanePair child = childOf(pair, opened, out, lane);
      const NodeSupport own = opened == Opened::a ? supportOf(a, child.a) : supportOf(b, child.b);
      const bool of_a = opened == Opened::a;
      if (areFarNodesApart(distance, a.pose, of_a ? own : other, b.pose, of_a ? other : own, clearance,
                           work.exact_decisions) ||
          leafIsFarApart(child, opened, out.radius, out.radii[lane] * out.stretch, own, clearance))
        out.near &= ~(1u << lane);
    }
  }

  /// Whether the other side of a child is a leaf much larger than it, and the child is apart from each of its points.
  /// @param leaf_radius, radius of the leaf and of the child, in one unit. @param own the child's support
  bool leafIsFarApart(const LanePair& child, Opened opened, float leaf_radius, float radius, const NodeSupport& own,
                      double clearance)
  {
    const bool leaf_is_a = opened == Opened::b;
    if (!(leaf_radius > kLargeFarLeaf * radius) || !isLeaf(leaf_is_a ? a : b, leaf_is_a ? child.a : child.b) ||
        isLeaf(leaf_is_a ? b : a, leaf_is_a ? child.b : child.a))
      return false;
    return pointsFarApart(distance, {a.pose, a.storage.view}, {b.pose, b.storage.view},
                          leaf_is_a ? leaf(a, child.a) : leaf(b, child.b), leaf_is_a, own, clearance, work);
  }

  /// Whether both spheres of a pair are as small as the float error; one of them is child `lane` of the step.
  static bool isBlunt(const LanePair& pair, const Step& step, std::uint32_t lane)
  {
    const float blunt = step.frame->bluntRadius();
    return step.radius <= blunt && step.radii[lane] * step.stretch <= blunt && pair.a.space != kAboveVoxels &&
           pair.b.space != kAboveVoxels;
  }

  static GivenSphere givenSphere(const Spaces& side, const Lane& lane)
  {
    return givenSphereOf(side.storage.view, side.storage.voxels[lane.space], side.node(lane.space, lane.node),
                         lane.lane);
  }

  /// Removes children from the step's `near` which float arithmetic cannot tell from the other sphere, but whose points
  /// as given are apart from its points.
  void dropApartAsGiven(const LanePair& pair, Opened opened, double clearance, Step& out)
  {
    for (std::uint32_t bits = out.near; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
      const LanePair child = childOf(pair, opened, out, lane);
      if (!isBlunt(child, out, lane)) continue;
      const float radius = out.radii[lane] * out.stretch;
      const float between = out.gap[lane] + radius;
      if (!out.frame->isUndecided(between * between, radius + out.radius + out.frame->pruneReach(clearance))) continue;
      ++work.exact_decisions;
      if (areApart(distance, givenSphere(a, child.a), givenSphere(b, child.b), clearance)) out.near &= ~(1u << lane);
    }
  }

  /// `near` and `inside` of the first `count` spheres, against a ball of the other side, its radius stretched.
  void test(const RelativeFrame& frame, const SphereLanes& spheres, std::uint32_t count, const Point& center,
            float radius, double clearance, Step& out)
  {
    out.reach = frame.pruneReach(clearance);
    const QueryBall ball{center.x, center.y, center.z, radius + out.reach,
                         frame.acceptReach(clearance + accepted_beyond) - radius * (1.0f + kSphereMargin)};
    out.frame = &frame;
    out.radii = spheres.r;
    out.stretch = spheres.stretch;
    out.radius = radius;
    out.near = spheresNear(spheres, ball, out.gap) & firstBits(count);
    out.inside = spheresInside(spheres, ball) & firstBits(count);
    work.node_pairs += count;
  }
};

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle
