// SPDX-License-Identifier: BSD-3-Clause
// The simultaneous descent of two hierarchies, for queries that look for pairs of points. A step opens the larger
// sphere of a pair, and tests its children against the other sphere. visit_pairs-inl.h has the loop over pairs.

#if defined(PCL_BSH_TRAVERSAL_PAIR_WALK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAVERSAL_PAIR_WALK_INL_H_
#undef PCL_BSH_TRAVERSAL_PAIR_WALK_INL_H_
#else
#define PCL_BSH_TRAVERSAL_PAIR_WALK_INL_H_
#endif

#include <pcl_bsh/base/kept_scratch.h>
#include <pcl_bsh/traversal/pair_sides-inl.h>
#include <pcl_bsh/traversal/separation-inl.h>

#include <optional>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

class PairWalk : public PairSides {
public:
  PairWalk(const Placed& placed_a, const Placed& placed_b)
  : PairSides(placed_a, placed_b),
    separation_(distance, a, b, work)
  {
  }

  /// Number of pairs of leaves to compare before leaves are compared with far nodes point by point. Such a step takes
  /// microseconds: too long for callers that look at a clock between two steps.
  std::uint64_t pairs_before_points = 0;

  /// Whether a cloud is of triangles, so that leaves are compared by eachPairNearTriangles().
  bool haveTriangles() const { return a.storage.view.triangles || b.storage.view.triangles; }

  /// b's triangles laid flat. @pre b is of triangles
  FlatRecords& flat()
  {
    if (!flat_) {
      flat_.emplace();
      (**flat_).prepare(b.storage);
    }
    return **flat_;
  }

  /// Opens pair.a and tests its children against pair.b, or the other way round.
  /// @tparam kBounds whether to compute lower bounds, too, for boundKeys()
  /// @param reach how far apart points are still of interest, less their radii, in the clouds' unit
  template <bool kBounds = false>
  void step(const LanePair& pair, Opened opened, double reach, Step& out)
  {
    if (opened == Opened::a)
      testChildrenOfA<kBounds>(enter(a, pair.a), pair.b, reach, out);
    else
      testChildrenOfB<kBounds>(pair.a, enter(b, pair.b), reach, out);
    if (kBounds && out.near != 0 && out.have_slabs && std::isfinite(reach) && !distance.ofTriangles())
      boundByLeafPoints(pair, opened, out); // a triangle is more than its leaf's point
    const bool is_larger = out.radius > kLargeLeaf * out.children.r[0] * out.children.stretch;
    const bool is_blunt = out.radius <= out.frame->bluntRadius();
    if (HWY_UNLIKELY(is_larger || is_blunt || mayBeFar(out.reach, out.radius) || distance.ofTriangles()) &&
        out.near != 0)
      lookAgain<kBounds>(pair, opened, reach, out);
  }

  /// Call before seedWhole(), and before visiting pairs that another walk got from seedWhole().
  void makeWholes()
  {
    if (a.storage.size != 0) a.makeWhole();
    if (b.storage.size != 0) b.makeWhole();
  }

  /// Calls push(pair, step) for the pair of both whole clouds, if they may meet. boundKeys() takes the step.
  template <class Push>
  void seedWhole(double reach, const Push& push)
  {
    if (a.storage.size == 0 || b.storage.size == 0) return;
    const LanePair pair{0.0f, {kAboveVoxels, a.whole(), 0}, {kAboveVoxels, b.whole(), 0}};
    Step found;
    testChildrenOfB<true>(pair.a, pair.b, reach, found);
    if (found.near != 0) push(childOf(pair, Opened::b, found, 0), found);
  }

  /// Calls push(pair, step, lane) for every pair of children of the two roots that may meet.
  template <class Push>
  void seed(double reach, const Push& push)
  {
    if (a.storage.size == 0 || b.storage.size == 0) return;
    if (frames.find(kAboveVoxels, kAboveVoxels).separates(reach + a.storage.largest_radius + b.storage.largest_radius))
      return;
    Step found;
    for (std::uint32_t i = 0; i < a.storage.top[0].count; ++i) {
      const LanePair pair{0.0f, {kAboveVoxels, 0, i}, {kAboveVoxels, 0, 0}};
      testChildrenOfB<false>(pair.a, pair.b, reach, found);
      for (const std::uint32_t lane : Bits(found.near)) push(childOf(pair, Opened::b, found, lane), found, lane);
    }
  }

  /// Returns two leaves, and which points of a's may be near b's.
  /// @param reach as step() takes it; without it, all points may be near
  ComparedLeaves compare(const LanePair& pair, std::optional<double> reach = std::nullopt)
  {
    ++work.leaf_pairs;
    ComparedLeaves leaves(leaf(a, pair.a), leaf(b, pair.b), frames.find(pair.a.space, pair.b.space),
                          b.frame(pair.b.space).unit);
    if (reach)
      leaves.near = pointsNearLeaf(leaves.frame, leaves.points, leaves.a, nodeOf(b, pair.b), pair.b.lane, *reach);
    return leaves;
  }

private:
  /// Returns the node below a lane that is not a leaf. Builds a voxel that it enters.
  Lane enter(const Spaces& side, const Lane& lane)
  {
    const Node& node = nodeOf(side, lane);
    if (!node.isLeaf(lane.lane)) return {lane.space, node.child[lane.lane], 0};
    side.voxel(node.begin[lane.lane], work);
    return {node.begin[lane.lane], 0, 0};
  }

  template <bool kBounds>
  void testChildrenOfA(const Lane& entered, const Lane& lane_b, double reach, Step& out)
  {
    const RelativeFrame& frame = frames.find(entered.space, lane_b.space);
    const Node& node = nodeOf(a, entered);
    const Node& other = nodeOf(b, lane_b);
    carry(frame.m.data(), frame.g.data(), node.x, node.y, node.z, kLanes, out.x, out.y, out.z);
    work.volumes_carried += node.count;
    out.entered = entered;
    out.of_a = true;
    out.children = {out.x, out.y, out.z, node.r, frame.stretch_a};
    const Point center{other.x[lane_b.lane], other.y[lane_b.lane], other.z[lane_b.lane]};
    test(frame, node.count, center, other.r[lane_b.lane] * frame.stretch_b, reach, out);
    if (kBounds) forgetBounds(out);
    if (out.near == 0 || !haveSlabs(entered, lane_b)) return;
    const Slabs &own = slabsOf(a, entered), &others = slabsOf(b, lane_b);
    alignas(32) float nx[kLanes], ny[kLanes], nz[kLanes];
    carry(frame.m.data(), kNowhere, own.x, own.y, own.z, kLanes, nx, ny, nz);
    compareSlabs<kBounds>({nx, ny, nz, own.h}, slabOf(others, lane_b.lane, center, out.radius), out);
  }

  template <bool kBounds>
  void testChildrenOfB(const Lane& lane_a, const Lane& entered, double reach, Step& out)
  {
    const RelativeFrame& frame = frames.find(lane_a.space, entered.space);
    const Node& node = nodeOf(b, entered);
    const Node& other = nodeOf(a, lane_a);
    out.entered = entered;
    out.of_a = false;
    out.children = {node.x, node.y, node.z, node.r, frame.stretch_b};
    const Point center = carriedCenter(frame, other, lane_a.lane);
    ++work.volumes_carried;
    test(frame, node.count, center, other.r[lane_a.lane] * frame.stretch_a, reach, out);
    if (kBounds) forgetBounds(out);
    if (out.near == 0 || !haveSlabs(lane_a, entered)) return;
    const Slabs &own = slabsOf(b, entered), &others = slabsOf(a, lane_a);
    Slab other_slab = slabOf(others, lane_a.lane, center, out.radius);
    other_slab.normal = carryPoint(frame.m.data(), kNowhere, other_slab.normal);
    compareSlabs<kBounds>({own.x, own.y, own.z, own.h}, other_slab, out);
  }

  static void forgetBounds(Step& out)
  {
    std::fill_n(out.slab_gap, kLanes, std::numeric_limits<float>::lowest());
    out.have_slabs = false;
  }

  template <bool kBounds>
  static void compareSlabs(const SlabLanes& slabs, const Slab& other, Step& out)
  {
    if constexpr (!kBounds) {
      out.near &= ~slabsApart(out.children, slabs, other, out.reach);
      return;
    }
    out.have_slabs = true;
    slabGaps(out.children, slabs, other, out.slab_gap);
    out.near &= ~gapsBeyond(out.slab_gap, out.reach);
  }

  /// Raises the bounds of a leaf beside a node that is not much larger, by how far the node reaches towards each of the
  /// leaf's points.
  HWY_NOINLINE void boundByLeafPoints(const LanePair& pair, Opened opened, Step& out)
  {
    const bool of_a = opened == Opened::a;
    const Spaces &own = of_a ? a : b, &others = of_a ? b : a;
    const Lane& other = of_a ? pair.b : pair.a;
    const Node& node = nodeOf(own, out.entered);
    const bool other_is_leaf = isLeaf(others, other);
    const auto radiusOf = [&](std::uint32_t lane) { return out.children.r[lane] * out.children.stretch; };
    const auto isAsked = [&](std::uint32_t lane) {
      return other_is_leaf ? out.radius > kLeafBesideNode * radiusOf(lane)
                           : node.isLeaf(lane) && radiusOf(lane) > kLeafBesideNode * out.radius;
    };
    std::uint32_t asked = 0;
    for (const std::uint32_t lane : Bits(out.near))
      if (isAsked(lane)) asked |= 1u << lane;
    if (asked == 0) return;
    const bool carries_slab = of_a == other_is_leaf; // the slab is a's; else the points are
    const Slabs& slabs = other_is_leaf ? slabsOf(own, out.entered) : slabsOf(others, other);
    const auto slabOfNode = [&](std::uint32_t lane, const Point& center, float radius) {
      Slab slab = slabOf(slabs, lane, center, radius);
      if (carries_slab) slab.normal = carryPoint(out.frame->m.data(), kNowhere, slab.normal);
      return slab;
    };
    LeafPoints points;
    const float *x = nullptr, *y = nullptr, *z = nullptr;
    const auto take = [&](const LeafRange& leaf) {
      if (carries_slab) {
        x = leaf.x(), y = leaf.y(), z = leaf.z();
        return;
      }
      carryLeaf(*out.frame, leaf, points);
      x = points.x, y = points.y, z = points.z;
    };
    LeafRange leaf;
    Slab slab{};
    if (other_is_leaf)
      take(leaf = this->leaf(others, other));
    else
      slab = slabOfNode(other.lane, out.center, out.radius);
    for (const std::uint32_t lane : Bits(asked)) {
      if (other_is_leaf)
        slab = slabOfNode(lane, {out.children.x[lane], out.children.y[lane], out.children.z[lane]}, radiusOf(lane));
      else
        take(leaf = leafOf(own, out.entered.space, node, lane));
      raise(out, lane, pointsGap(x, y, z, leaf.count, slab));
    }
  }

  static void raise(Step& out, std::uint32_t lane, float gap)
  {
    out.slab_gap[lane] = std::max(out.slab_gap[lane], gap);
    if (gap * (1.0f - kSphereMargin) > out.reach) out.near &= ~(1u << lane);
  }

  /// Raises the bounds of nodes far from each other for their size, by their supports.
  HWY_NOINLINE void boundBySupports(const LanePair& child, Step& out)
  {
    std::uint32_t far = out.near & spheresFar(out.gap, out.children.r, out.children.stretch, out.radius, kFarNodes);
    if (far == 0) return;
    const Spaces &own = out.of_a ? a : b, &others = out.of_a ? b : a;
    const Lane& other = out.of_a ? child.b : child.a;
    const Slabs &slabs = slabsOf(own, out.entered), &cross = crossSlabsOf(own, out.entered),
                &other_slabs = slabsOf(others, other), &other_cross = crossSlabsOf(others, other);
    const std::uint32_t k = other.lane;
    CrossedSlabs held{{other_slabs.x[k], other_slabs.y[k], other_slabs.z[k]},
                      {other_cross.x[k], other_cross.y[k], other_cross.z[k]},
                      other_slabs.h[k],
                      other_cross.h[k],
                      out.center,
                      out.radius};
    alignas(32) float gaps[kLanes];
    const float* m = out.frame->m.data();
    if (out.of_a) {
      alignas(32) float n[3][kLanes], c[3][kLanes];
      carry(m, kNowhere, slabs.x, slabs.y, slabs.z, kLanes, n[0], n[1], n[2]);
      carry(m, kNowhere, cross.x, cross.y, cross.z, kLanes, c[0], c[1], c[2]);
      supportGaps(out.children, {n[0], n[1], n[2], slabs.h}, {c[0], c[1], c[2], cross.h}, held, gaps);
    }
    else {
      held.normal = carryPoint(m, kNowhere, held.normal);
      held.cross = carryPoint(m, kNowhere, held.cross);
      supportGaps(out.children, {slabs.x, slabs.y, slabs.z, slabs.h}, {cross.x, cross.y, cross.z, cross.h}, held, gaps);
    }
    for (const std::uint32_t lane : Bits(far)) raise(out, lane, gaps[lane]);
  }

  /// Tests the first `count` children against a sphere of the other side, its radius stretched. Sets `near`.
  void test(const RelativeFrame& frame, std::uint32_t count, const Point& center, float radius, double reach, Step& out)
  {
    out.frame = &frame;
    out.count = count;
    out.center = center;
    out.radius = radius;
    out.reach = frame.pruneReach(reach);
    out.near =
        spheresNear(out.children, {center.x, center.y, center.z, radius + out.reach, 0.0f}, out.gap) & firstBits(count);
    work.node_pairs += count;
  }

  /// Tests children again where spheres prune least, as separation-inl.h says.
  template <bool kBounds>
  HWY_NOINLINE void lookAgain(const LanePair& pair, Opened opened, double reach, Step& out)
  {
    const bool of_a = opened == Opened::a;
    const LanePair child = childOf(pair, opened, out, 0);
    const Spaces &own = of_a ? a : b, &others = of_a ? b : a;
    const Lane &lane = of_a ? child.a : child.b, &other = of_a ? child.b : child.a;
    const ChildrenAndSphere compared{*out.frame,
                                     of_a,
                                     voxelOf(own, lane),
                                     nodeOf(own, lane),
                                     out.children,
                                     voxelOf(others, other),
                                     nodeOf(others, other),
                                     other.lane,
                                     out.center,
                                     out.radius,
                                     reach};
    if (out.radius <= out.frame->bluntRadius() && compared.areInVoxels())
      out.near &= ~separation_.asGiven(compared, out.near);
    if (out.near != 0 && out.radius > kLargeLeaf * compared.radiusOf(0) && isLeafApart(pair, opened, reach))
      out.near = 0;
    if (out.near != 0 && mayBeFar(out.reach, out.radius) && std::isfinite(reach) && haveSlabs(child.a, child.b)) {
      if (kBounds) boundBySupports(child, out);
      if (out.near != 0)
        out.near &= ~separation_.byExtent(compared, out.gap, out.near, work.leaf_pairs >= pairs_before_points);
    }
    if (out.near != 0 && distance.ofTriangles() && std::isfinite(reach))
      out.near &= ~separation_.byTriangles(compared, out.near, [this]() -> FlatRecords& { return flat(); });
  }

  /// Whether the side of a pair that was not opened is a leaf much larger than the opened node, and has no point near
  /// it. (Of two inner nodes, the larger one is opened. Children are compared so when their own turn comes.)
  bool isLeafApart(const LanePair& pair, Opened opened, double reach)
  {
    const bool leaf_is_a = opened == Opened::b;
    const Node &node_a = nodeOf(a, pair.a), &node_b = nodeOf(b, pair.b);
    const double ra = node_a.r[pair.a.lane] * a.frame(pair.a.space).unit;
    const double rb = node_b.r[pair.b.lane] * b.frame(pair.b.space).unit;
    if (!(leaf_is_a ? ra > kLargeLeaf * rb : rb > kLargeLeaf * ra)) return false;
    const RelativeFrame& frame = frames.find(pair.a.space, pair.b.space);
    const std::uint32_t k = pair.b.lane;
    if (leaf_is_a)
      return separation_.isLeafApart(frame, leaf(a, pair.a), true, {node_b.x[k], node_b.y[k], node_b.z[k]},
                                     node_b.r[k] * frame.stretch_b, reach);
    return separation_.isLeafApart(frame, leaf(b, pair.b), false, carriedCenter(frame, node_a, pair.a.lane),
                                   node_a.r[pair.a.lane] * frame.stretch_a, reach);
  }

  const Separation separation_;
  std::optional<ScratchLease<FlatRecords>> flat_;
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
