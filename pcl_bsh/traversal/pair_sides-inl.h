// SPDX-License-Identifier: BSD-3-Clause
// Two posed hierarchies that are descended together: pairs of their nodes, the result of testing a node's children, and
// lower bounds from it.

#if defined(PCL_BSH_TRAVERSAL_PAIR_SIDES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAVERSAL_PAIR_SIDES_INL_H_
#undef PCL_BSH_TRAVERSAL_PAIR_SIDES_INL_H_
#else
#define PCL_BSH_TRAVERSAL_PAIR_SIDES_INL_H_
#endif

#include <pcl_bsh/traversal/behind_plane.h>
#include <pcl_bsh/traversal/separation-inl.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

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

/// Memory that the stacks of searches use one after another; a ScratchLease lends it.
struct PairStack {
  std::vector<LanePair> pairs;
  std::size_t bytes() const noexcept { return pairs.capacity() * sizeof(LanePair); }
};

/// The side of a pair that is opened.
enum class Opened : std::uint8_t { a, b, neither };

/// Orders the pairs from `from` on so that the nearest is last, to be taken first. Insertion keeps the order of equals,
/// and a step adds eight at most.
template <class Pair>
void nearestLast(std::vector<Pair>& stack, std::size_t from)
{
  for (std::size_t i = from + 1; i < stack.size(); ++i) {
    const Pair pair = stack[i];
    std::size_t k = i;
    for (; k > from && stack[k - 1].key < pair.key; --k) stack[k] = stack[k - 1];
    stack[k] = pair;
  }
}

class PairSides {
public:
  PairSides(const Placed& placed_a, const Placed& placed_b)
  : a(placed_a),
    b(placed_b),
    frames(a, b),
    distance(placed_a.hierarchy().view(), placed_a.pose, placed_b.hierarchy().view(), placed_b.pose)
  {
  }

  Spaces a, b;
  FrameTable frames;
  RecordDistance distance;
  Work work;

  const Node& nodeOf(const Spaces& side, const Lane& lane) const { return side.node(lane.space, lane.node); }

  NodeChild child(const Spaces& side, const Lane& lane) const { return {lane.space, nodeOf(side, lane), lane.lane}; }

  bool isLeaf(const Spaces& side, const Lane& lane) const
  {
    return lane.space != kAboveVoxels && nodeOf(side, lane).isLeaf(lane.lane);
  }

  LeafRange leaf(const Spaces& side, const Lane& lane) const
  {
    return leafOf(side, lane.space, nodeOf(side, lane), lane.lane);
  }

  /// The smallest records below both lanes.
  PointPair lowest(const LanePair& pair) const
  {
    return {nodeOf(a, pair.a).lowest[pair.a.lane], nodeOf(b, pair.b).lowest[pair.b.lane]};
  }

  /// Returns the side with the larger sphere, in the clouds' unit; beside a leaf, the side that is no leaf.
  Opened choose(const LanePair& pair) const
  {
    const bool leaf_a = isLeaf(a, pair.a), leaf_b = isLeaf(b, pair.b);
    if (leaf_a && leaf_b) return Opened::neither;
    if (leaf_a != leaf_b) return leaf_a ? Opened::b : Opened::a;
    const double ra = nodeOf(a, pair.a).r[pair.a.lane] * a.frame(pair.a.space).unit;
    const double rb = nodeOf(b, pair.b).r[pair.b.lane] * b.frame(pair.b.space).unit;
    return ra > rb ? Opened::a : Opened::b;
  }

  /// The level of the node that opening a pair reads: 0 above the voxels and of two leaves, 1 the root of a voxel.
  std::uint64_t levelToOpen(const LanePair& pair) const
  {
    const Opened opened = choose(pair);
    if (opened == Opened::neither) return 0;
    const Spaces& side = opened == Opened::a ? a : b;
    const Lane& lane = opened == Opened::a ? pair.a : pair.b;
    if (lane.space == kAboveVoxels) return nodeOf(side, lane).isLeaf(lane.lane) ? 1 : 0;
    const std::vector<Node>& nodes = side.storage.voxels[lane.space].nodes;
    const std::uint32_t first = nodes[lane.node].begin[lane.lane];
    std::uint64_t level = 2;
    for (std::uint32_t node = 0; node != lane.node; ++level) {
      std::uint32_t above = 0;
      while (nodes[node].begin[above + 1] <= first) ++above;
      node = nodes[node].child[above];
    }
    return level;
  }

  /// How many points a step that opens a pair would build trees of, or fit slabs to.
  std::size_t pointsToPrepare(const LanePair& pair, Opened opened) const
  {
    const auto voxelIn = [](const Spaces& side, const Lane& lane, bool enters) {
      const Node& node = side.node(lane.space, lane.node);
      return enters && lane.space == kAboveVoxels && node.isLeaf(lane.lane) ? node.begin[lane.lane] : lane.space;
    };
    const std::uint32_t in_a = voxelIn(a, pair.a, opened == Opened::a), in_b = voxelIn(b, pair.b, opened == Opened::b);
    const bool compares_slabs = in_a != kAboveVoxels && in_b != kAboveVoxels;
    const auto pointsOf = [compares_slabs](const Spaces& side, std::uint32_t space) -> std::size_t {
      if (space == kAboveVoxels) return 0;
      const std::size_t points = side.storage.pointsToBuild(space);
      const Voxel& voxel = side.storage.voxels[space];
      return points == 0 && compares_slabs && !voxel.slabs.isFitted() ? voxel.count : points;
    };
    return pointsOf(a, in_a) + pointsOf(b, in_b);
  }

  /// Whether slabs can be compared: both lanes are in voxels of one unit, and records are no balls.
  bool haveSlabs(const Lane& lane_a, const Lane& lane_b) const
  {
    return lane_a.space != kAboveVoxels && lane_b.space != kAboveVoxels && !a.storage.view.areBalls() &&
           !b.storage.view.areBalls() && a.frame(lane_a.space).unit == b.frame(lane_b.space).unit;
  }

  const Slabs& slabsOf(const Spaces& side, const Lane& lane)
  {
    Voxel& voxel = side.storage.voxels[lane.space];
    return voxel.slabs.of(voxel, side.storage.view, work)[lane.node];
  }

  /// The sum of both radii, in the clouds' unit. Gaps of points below differ by at most twice that.
  double radiiOf(const LanePair& pair) const
  {
    return nodeOf(a, pair.a).r[pair.a.lane] * a.frame(pair.a.space).unit +
           nodeOf(b, pair.b).r[pair.b.lane] * b.frame(pair.b.space).unit;
  }

  /// The result of a step: bits of the children that are near, and the figures of the tests, in the frame of b's space.
  struct Step {
    Lane entered;           ///< the node whose children were tested
    bool of_a = false;      ///< whether it is a's
    std::uint32_t near = 0; ///< bit i: child i is not proven to be apart
    std::uint32_t count = 0;
    float gap[kLanes]; ///< from the other sphere's centre to each child, by spheresNear()
    /// If bounds were asked for: lower bounds of distances, by slabs and by leaves; lowest() where these tell nothing.
    float slab_gap[kLanes];
    bool have_slabs = false; ///< if bounds were asked for: whether slabs were compared
    const RelativeFrame* frame = nullptr;
    SphereLanes children;
    Point center;                                      ///< of the other sphere
    float radius = 0.0f;                               ///< of the other sphere, stretched
    float reach = 0.0f;                                ///< points farther apart are of no interest
    alignas(32) float x[kLanes], y[kLanes], z[kLanes]; ///< centres of a's children, carried

    Step() = default;
    Step(const Step&) = delete; // `children` points into it
    Step& operator=(const Step&) = delete;

    /// Returns bits of the children all of whose points are within a length of all points of the other sphere.
    /// @param length in the clouds' unit; may be below 0
    std::uint32_t inside(double length) const
    {
      if (!(length > 0.0)) return 0;
      const float most = frame->acceptReach(length) - radius * (1.0f + kSphereMargin);
      return spheresInside(children, {center.x, center.y, center.z, 0.0f, most}) & firstBits(count);
    }
  };

  template <class Pair>
  static Pair childOf(const Pair& pair, Opened opened, const Step& step, std::uint32_t lane)
  {
    Pair child = pair;
    (opened == Opened::a ? child.a : child.b) = {step.entered.space, step.entered.node, lane};
    child.key = step.gap[lane];
    return child;
  }

  /// Returns a lower bound of distances of points below child `lane` of a step, in the clouds' unit; may be negative.
  /// @param pair the child, as childOf() has it: the pair that was opened may be in a space of another unit
  double lowerBound(const LanePair& pair, const Step& step, std::uint32_t lane) const
  {
    const double gap = step.gap[lane], radius = step.children.r[lane] * step.children.stretch;
    const double rounding = static_cast<double>(kSphereMargin) * (std::abs(gap) + 2 * radius + step.radius);
    const double bound =
        gap - rounding - static_cast<double>(step.radius) - static_cast<double>(step.frame->pruneReach(0.0));
    const double stored = (bound - std::abs(bound) * step.frame->skew()) * b.frame(pair.b.space).unit;
    const float blunt = step.frame->bluntRadius();
    const bool is_blunt = step.radius <= blunt && step.children.r[lane] * step.children.stretch <= blunt &&
                          pair.a.space != kAboveVoxels && pair.b.space != kAboveVoxels;
    if (!is_blunt) return stored;
    const GivenSphere given_a = givenSphere(a, pair.a), given_b = givenSphere(b, pair.b);
    const double given = distance.ofPoints().enclose(given_a.center, given_b.center).low -
                         (given_a.radius + given_b.radius) * (1.0 + 2 * kPoseStretch);
    return std::isfinite(given) ? std::max(stored, given) : stored;
  }

  /// Returns lowerBound() rounded down, as a key; minus infinity where it is NaN.
  float boundKey(const LanePair& pair, const Step& step, std::uint32_t lane) const
  {
    const double bound = lowerBound(pair, step, lane);
    return std::isnan(bound) ? -std::numeric_limits<float>::infinity() : roundDown(bound);
  }

  /// Sets the keys of a step's children to lower bounds; minus infinity where there is no bound.
  /// @param pair any one of the children @param step made with kBounds
  void boundKeys(const LanePair& pair, const Step& step, float* keys) const
  {
    const auto boundNear = [&](const auto& take) {
      for (const std::uint32_t lane : Bits(step.near)) {
        LanePair child = pair;
        (step.of_a ? child.a : child.b).lane = lane;
        keys[lane] = take(keys[lane], boundKey(child, step, lane));
      }
    };
    // In smaller units keys are near the least floats, where these do not round relatively.
    if (HWY_UNLIKELY(b.frame(pair.b.space).unit < 0x1p-60)) return boundNear([](float, float key) { return key; });
    const LaneTag d;
    const LaneVector error = hn::Set(d, step.frame->pruneReach(0.0) * (1.0f + kReachMargin));
    const LaneVector skew = hn::Set(d, roundUp(step.frame->skew()) + 4 * kReachMargin);
    const LaneVector unit = hn::Set(d, roundToFloat(b.frame(pair.b.space).unit));
    const LaneVector radius = hn::Set(d, step.radius);
    const LaneVector none = hn::Set(d, -std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
      const LaneVector gap = hn::LoadU(d, step.gap + i);
      const LaneVector r = hn::Mul(hn::LoadU(d, step.children.r + i), hn::Set(d, step.children.stretch));
      const LaneVector sizes = hn::Add(hn::Add(hn::Abs(gap), hn::Add(r, r)), radius);
      const LaneVector by_spheres = hn::Sub(hn::Sub(gap, radius), hn::Mul(sizes, hn::Set(d, 2 * kSphereMargin)));
      const LaneVector by_slabs = hn::Mul(hn::LoadU(d, step.slab_gap + i), hn::Set(d, 1.0f - kSphereMargin));
      const LaneVector bound = hn::Sub(hn::IfThenElse(hn::Gt(by_slabs, by_spheres), by_slabs, by_spheres), error);
      const LaneVector key = hn::Mul(hn::Sub(bound, hn::Mul(hn::Abs(bound), skew)), unit);
      hn::StoreU(hn::IfThenElse(hn::IsFinite(key), key, none), d, keys + i);
    }
    if (HWY_LIKELY(step.radius > step.frame->bluntRadius())) return;
    boundNear([](float by_stored, float key) { return std::max(by_stored, key); });
  }

protected:
  static Voxel* voxelOf(const Spaces& side, const Lane& lane)
  {
    return lane.space == kAboveVoxels ? nullptr : &side.storage.voxels[lane.space];
  }

  const Slabs& crossSlabsOf(const Spaces& side, const Lane& lane)
  {
    Voxel& voxel = side.storage.voxels[lane.space];
    return voxel.cross_slabs.of(voxel, side.storage.view, work)[lane.node];
  }

  static GivenSphere givenSphere(const Spaces& side, const Lane& lane)
  {
    return givenSphereOf(side.storage.view, side.storage.voxels[lane.space], side.node(lane.space, lane.node),
                         lane.lane);
  }
};

/// A node's sphere between the planes of its slab, in the world. A normal of 0 proves nothing.
struct WorldSlab {
  Eigen::Vector3d normal;
  double h, radius;

  /// How far from its centre it reaches along a unit vector. Normals are not quite of length one: kSlabMargin of all
  /// lengths pays for that.
  double support(const Eigen::Vector3d& along) const
  {
    return std::abs(normal.dot(along)) * h + normal.cross(along).norm() * radius;
  }
};

/// @pre PairSides::haveSlabs(). @param radius of the lane's sphere, in the clouds' unit
inline WorldSlab worldSlabOf(PairSides& sides, const Spaces& side, const Lane& lane, double radius)
{
  const Slabs& slabs = sides.slabsOf(side, lane);
  const Eigen::Vector3d normal(slabs.x[lane.lane], slabs.y[lane.lane], slabs.z[lane.lane]);
  return {side.pose.linear() * normal, slabs.h[lane.lane] * side.frame(lane.space).unit, radius};
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
