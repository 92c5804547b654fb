// SPDX-License-Identifier: BSD-3-Clause
// The nearest record of b to one triangle of a, which goes down the tree of b by itself. The ball around a long
// triangle holds much that is far from it; the spheres of b are compared with the triangle, in the frame of its voxel.

#if defined(PCL_BSH_DISTANCES_TRIANGLE_DESCENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_DISTANCES_TRIANGLE_DESCENT_INL_H_
#undef PCL_BSH_DISTANCES_TRIANGLE_DESCENT_INL_H_
#else
#define PCL_BSH_DISTANCES_TRIANGLE_DESCENT_INL_H_
#endif

#include <pcl_bsh/distances/measured_leaf-inl.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// Measures triangles of one voxel of a.
class TriangleDescent {
public:
  explicit TriangleDescent(MeasuredLeaf& leaf)
  : leaf_(leaf),
    a_(leaf.query.a),
    b_(leaf.query.b),
    rotation_(leaf.query.b.pose, leaf.query.a.pose),
    compares_slabs_(!leaf.view_b.areBalls())
  {
  }

  /// Call before the first triangle of a leaf, which is child `lane` of the node.
  void begin(const Node& node, std::uint32_t lane)
  {
    node_ = &node;
    lane_ = lane;
  }

  /// The nearest record of b to triangle i of the leaf. @param list spheres that hold all that can be the nearest
  /// @param cut the triangle is no farther than this from b, unless it is beyond max_distance
  /// @param below(sphere) returns the first child of a sphere; not called for leaves
  template <class Below>
  NearestFound nearest(std::uint32_t i, float cut, const std::vector<NearSphere>& list, const Below& below)
  {
    const std::uint32_t record = leaf_.range.record(i);
    flat_ = FlatRecord::of(leaf_.range.voxel->frame, record, leaf_.view_a.triangles->triangle(record));
    BestRecord best(leaf_, i, cut);
    limit_ = cut;
    near_.clear();
    for (std::size_t k = 0; k < list.size();) { // neighbours of one node at once
      const ObstacleSphere& sphere = list[k].sphere;
      std::uint32_t lanes = 0;
      for (; k < list.size() && list[k].sphere.node == sphere.node; ++k) lanes |= 1u << list[k].sphere.lane;
      alignas(32) float lower[kLanes];
      bound(sphere, lanes, lower);
      for (const std::uint32_t lane : Bits(lanes)) {
        ObstacleSphere one = sphere;
        one.lane = static_cast<std::uint16_t>(lane);
        near_.push_back({one, lower[one.lane]});
      }
    }
    std::sort(near_.begin(), near_.end(), [](const NearSphere& x, const NearSphere& y) { return x.lower < y.lower; });
    for (const NearSphere& near : near_) {
      if (near.lower > limit_ || leaf_.query.exceeds(limit_)) break;
      take(near.sphere, best, below);
    }
    return best.found();
  }

  /// Upper bound of the distance of the last triangle, in the walk's unit.
  float limit() const { return limit_; }

private:
  template <class Below>
  void take(const ObstacleSphere& sphere, BestRecord& best, const Below& below)
  {
    if (sphere.level > 0 && sphere.isLeaf()) return takeLeaf(sphere, best);
    ObstacleSphere child = below(sphere);
    const Node& node = *child.node;
    alignas(32) float lower[kLanes];
    bound(child, firstBits(node.count), lower);
    for (std::uint32_t lanes = firstBits(node.count); lanes != 0;) {
      const std::uint32_t lane = smallestLane(lower, lanes);
      lanes &= ~(1u << lane);
      if (lower[lane] > limit_ || leaf_.query.exceeds(limit_)) break;
      child.lane = static_cast<std::uint16_t>(lane);
      take(child, best, below);
    }
  }

  /// Sets lower bounds of the distances from the triangle to what is in some children of a node. Lowers the limit to
  /// upper bounds, because each child holds a record.
  void bound(const ObstacleSphere& sphere, std::uint32_t lanes, float* lower)
  {
    leaf_.pulse.look();
    const LaneTag d;
    const Node& node = *sphere.node;
    const DistanceObstacle& own = frameOf(sphere.obstacle);
    CarriedNode carried;
    carry(own.frame.m.data(), own.frame.g.data(), node.x, node.y, node.z, kLanes, carried.x, carried.y, carried.z);
    alignas(32) float upper[kLanes];
    squaredToTriangle(flat_.flat, carried.x, carried.y, carried.z, kLanes, lower);
    const float error = errorIn(own);
    for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
      const LaneVector radius = hn::Mul(hn::LoadU(d, node.r + i), hn::Set(d, own.frame.stretch_a));
      hn::StoreU(radius, d, carried.r + i);
      boundOne(own, hn::Load(d, lower + i), radius, error, lower + i, upper + i);
    }
    leaf_.work.node_pairs += static_cast<std::uint64_t>(std::popcount(lanes));
    leaf_.work.volumes_carried += node.count;
    lowerLimit(upper, lanes);
    if (compares_slabs_ && sphere.level > 0 && isFar(lower, node.count, carried.r[0] * own.most)) {
      const Voxel& voxel = *leaf_.obstacles[sphere.obstacle].voxel;
      carrySlabs(own, slabsOf(b_, voxel, node), carried);
      raiseByBothSlabs(carried, own, ownSlab(own), lower);
    }
  }

  /// The slabs of a node of a voxel. They are fitted when first asked for.
  const Slabs& slabsOf(const Spaces& side, const Voxel& voxel, const Node& node)
  {
    Voxel* const first = side.storage.voxels.get();
    return first[&voxel - first].slabs.of(voxel, side.storage.view, leaf_.work)[&node - voxel.nodes.data()];
  }

  /// The slab of the leaf.
  Slab ownSlab(const DistanceObstacle& own)
  {
    const Slabs& slabs = slabsOf(a_, *leaf_.range.voxel, *node_);
    return slabOf(slabs, lane_, {node_->x[lane_], node_->y[lane_], node_->z[lane_]},
                  node_->r[lane_] * own.frame.stretch_b);
  }

  void takeLeaf(const ObstacleSphere& sphere, BestRecord& best)
  {
    const LaneTag d;
    const LeafRange other = sphere.leaf(*leaf_.obstacles[sphere.obstacle].voxel);
    const DistanceObstacle& own = frameOf(sphere.obstacle);
    LeafPoints points;
    carryLeaf(own.frame, other, points);
    alignas(64) float lower[kLeafPoints], upper[kLeafPoints], radii[kLeafPoints] = {};
    squaredToTriangle(flat_.flat, points.x, points.y, points.z, kLeafPoints, lower);
    const float stretch = stretchOf(own), error = errorIn(own);
    for (std::uint32_t j = 0; leaf_.view_b.radii && j < other.count; ++j)
      radii[j] = enough(other.radius(j) * double{stretch});
    for (std::size_t i = 0; i < kLeafPoints; i += hn::Lanes(d))
      boundOne(own, hn::Load(d, lower + i), hn::Load(d, radii + i), error, lower + i, upper + i);
    ++leaf_.work.leaf_pairs;
    lowerLimit(upper, firstBits(other.count));
    std::uint32_t near = firstBits(other.count) & ~above(lower, limit_);
    if (leaf_.view_b.triangles && near != 0) near = nearTriangles(own, other, near);
    while (near != 0) { // the nearest first: few others remain
      std::uint32_t nearest = static_cast<std::uint32_t>(std::countr_zero(near));
      for (const std::uint32_t j : Bits(near))
        if (lower[j] < lower[nearest]) nearest = j;
      near &= ~(1u << nearest);
      if (lower[nearest] > limit_) break;
      best.consider({other.voxel, other.begin + nearest});
      limit_ = std::min(limit_, roundUp(best.most() / leaf_.unit * (1.0 + kDoubleMargin)));
    }
  }

  /// The triangles of b's leaf that floats do not prove to be beyond the limit. Their corners lower the limit first, as
  /// a long triangle fills little of its ball.
  std::uint32_t nearTriangles(const DistanceObstacle& own, const LeafRange& other, std::uint32_t among)
  {
    const LaneTag d;
    carried_.carry(leaf_.view_b, other, own.frame);
    const float error = own.slack + roundUp(carried_.error + flat_.error(own.frame));
    alignas(64) float lower[kLeafPoints], upper[kLeafPoints];
    for (const LeafPoints& corner : carried_.leaf.corners) {
      squaredToTriangle(flat_.flat, corner.x, corner.y, corner.z, kLeafPoints, lower);
      for (std::size_t i = 0; i < kLeafPoints; i += hn::Lanes(d))
        boundOne(own, hn::Load(d, lower + i), hn::Zero(d), error, lower + i, upper + i);
      lowerLimit(upper, among);
    }
    const float reach = (limit_ * own.at_most_inside + error) * (1.0f + kFlatMargin);
    return among & ~compareWithTriangle(flat_.flat, carried_.leaf, among, reach, -1.0f).apart;
  }

  /// As boundsOfFlat() has them.
  static HWY_INLINE void boundOne(const DistanceObstacle& own, LaneVector squared, LaneVector radius, float error,
                                  float* lower, float* upper)
  {
    const LaneTag d;
    LaneVector low, high;
    boundsOfFlat(d, squared, radius, error, own, low, high);
    hn::Store(orNone(low), d, lower);
    hn::Store(high, d, upper);
  }

  void lowerLimit(const float* upper, std::uint32_t lanes)
  {
    for (const std::uint32_t lane : Bits(lanes)) limit_ = std::min(limit_, upper[lane]);
  }

  /// The error of carried places and of the triangle together, in the unit of its voxel.
  float errorIn(const DistanceObstacle& own) const { return roundUp(flat_.error(own.frame)) + own.slack; }

  /// The voxel of a, as seen from a space of b.
  const DistanceObstacle& frameOf(std::uint32_t obstacle)
  {
    if (frames_.size() <= obstacle) frames_.resize(obstacle + std::size_t{1});
    std::optional<DistanceObstacle>& own = frames_[obstacle];
    if (own) return *own;
    const LocalFrame &from = spaceOf(obstacle), &to = leaf_.range.voxel->frame;
    return own.emplace(leaf_.range.voxel, to, RelativeFrame(from, b_.pose, to, a_.pose, rotation_), leaf_.unit,
                       from.unit);
  }

  const LocalFrame& spaceOf(std::uint32_t obstacle) const
  {
    const Voxel* const voxel = leaf_.obstacles[obstacle].voxel;
    return voxel ? voxel->frame : b_.frame(kAboveVoxels);
  }

  MeasuredLeaf& leaf_;
  const Spaces a_, b_;
  const RelativeRotation rotation_; ///< of the poses of b and a
  const bool compares_slabs_;       ///< of both sides: balls have none
  const Node* node_ = nullptr;      ///< the leaf's
  std::uint32_t lane_ = 0;          ///< of it
  FlatRecord flat_;                 ///< the triangle in the frame of its voxel
  float limit_ = 0.0f;              ///< what is farther than this is not the nearest, in the walk's unit
  std::vector<std::optional<DistanceObstacle>> frames_; ///< by obstacle; empty until asked for
  std::vector<NearSphere> near_;
  CarriedTriangles carried_; ///< of a leaf of b, in the frame of a's voxel
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
