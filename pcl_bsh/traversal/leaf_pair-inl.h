// SPDX-License-Identifier: BSD-3-Clause
// Two leaves, point by point: float bands decide almost every pair, exact arithmetic the rest.

#if defined(PCL_BSH_TRAVERSAL_LEAF_PAIR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAVERSAL_LEAF_PAIR_INL_H_
#undef PCL_BSH_TRAVERSAL_LEAF_PAIR_INL_H_
#else
#define PCL_BSH_TRAVERSAL_LEAF_PAIR_INL_H_
#endif

#include <pcl_bsh/geometry/sphere_radius.h>
#include <pcl_bsh/simd/point_lanes-inl.h>
#include <pcl_bsh/traversal/point_pairs.h>

#include <algorithm>
#include <cmath>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// A leaf more than this many times as large as a node is compared by its points. The points lie far apart compared
/// with the node, so the leaf's sphere prunes nothing.
inline constexpr float kLargeLeaf = 8.0f;

/// For nodes far from each other a smaller ratio is enough: there the leaf's bend counts, the square of its size.
inline constexpr float kLargeFarLeaf = 2.0f;

/// A leaf more than this many times as large as a node is bounded by its points: they bound better than its sphere.
inline constexpr float kLeafBesideNode = 0.5f;

/// The centre of a's sphere in the frame of b.
HWY_INLINE Point carriedCenter(const RelativeFrame& frame, const Node& node, std::uint32_t lane)
{
  return carryPoint(frame.m.data(), frame.g.data(), {node.x[lane], node.y[lane], node.z[lane]});
}

/// Points [begin, begin + count) of a voxel: those of a leaf that are compared, sixteen at most.
struct LeafRange {
  const Voxel* voxel = nullptr;
  std::uint32_t begin = 0;
  std::uint32_t count = 0;

  const float* x() const { return voxel->x() + begin; }
  const float* y() const { return voxel->y() + begin; }
  const float* z() const { return voxel->z() + begin; }
  std::uint32_t record(std::uint32_t i) const { return voxel->records()[begin + i]; }
  double radius(std::uint32_t i) const { return voxel->radii ? voxel->radii[begin + i] : 0.0; }
  double smallestRadius() const
  {
    return voxel->radii ? *std::min_element(voxel->radii + begin, voxel->radii + begin + count) : 0.0;
  }
  double largestRadius() const
  {
    return voxel->radii ? *std::max_element(voxel->radii + begin, voxel->radii + begin + count) : 0.0;
  }
};

HWY_INLINE LeafRange leafOf(const Spaces& side, std::uint32_t space, const Node& node, std::uint32_t lane)
{
  return {&side.storage.voxels[space], node.begin[lane], node.comparedPoints(lane)};
}

/// The slab of one child of a node.
inline Slab slabOf(const Slabs& slabs, std::uint32_t lane, const Point& center, float radius)
{
  return {{slabs.x[lane], slabs.y[lane], slabs.z[lane]}, slabs.h[lane], center, radius};
}

/// A leaf of a in the frame of b's voxel.
HWY_INLINE void carryLeaf(const RelativeFrame& frame, const LeafRange& leaf, LeafPoints& out)
{
  carry(frame.m.data(), frame.g.data(), leaf.x(), leaf.y(), leaf.z(), leaf.count, out.x, out.y, out.z);
}

/// Which points of leaf a, carried, may collide with anything in the sphere of b's leaf.
HWY_INLINE std::uint32_t pointsNearLeaf(const RelativeFrame& frame, const LeafPoints& points, const LeafRange& a,
                                        const Node& node, std::uint32_t lane, double clearance)
{
  const float reach = node.r[lane] * frame.stretch_b + frame.pruneReach(clearance + a.largestRadius());
  return pointsNear(points.x, points.y, points.z, a.count, node.x[lane], node.y[lane], node.z[lane], reach,
                    kSphereMargin);
}

/// Calls found(i, j, squared) for pairs of a point of leaf a in `lanes` and a point of leaf b, in the order of b's
/// points. Leaves out pairs whose squared float distance exceeds `miss`. Stops when found() returns true.
template <class Leaf, class Found>
bool eachPairNotBeyond(const LeafPoints& points, std::uint32_t lanes, const Leaf& b, float miss, const Found& found)
{
  alignas(64) float squared[kLeafPoints];
  for (std::uint32_t j = 0; j < b.count && lanes != 0; ++j) {
    squaredDistances(points, b.x()[j], b.y()[j], b.z()[j], squared);
    for (const std::uint32_t i : Bits(lanes & ~above(squared, miss)))
      if (found(i, j, squared[i])) return true;
  }
  return false;
}

/// Returns a squared float distance: balls whose centres are no farther apart have a gap of at most `least`, for
/// certain. Returns -1 where no distance is short enough.
/// @param least as Reach has it; may be below 0
HWY_INLINE float ballHit(const RelativeFrame& frame, double least, double radius_a, double radius_b)
{
  // Two sums, each of which errs by a rounding of its terms at most.
  const double surely = least + radius_a + radius_b - kDoubleMargin * (std::abs(least) + radius_a + radius_b);
  return surely > 0.0 ? frame.band(surely).hit : -1.0f;
}

/// Calls found(i, j, squared, surely) for pairs of balls whose gap may be within the clearance, in the order of b's
/// points. `surely` tells that the gap is at most `least`, for certain. Stops when found() returns true.
/// @param least as Reach has it; minus infinity where no caller asks
template <class Found>
bool eachBallPairNear(const RelativeFrame& frame, const LeafPoints& points, std::uint32_t lanes, const LeafRange& a,
                      const LeafRange& b, double clearance, double least, const Found& found)
{
  const auto farthest = [&](double radius_a, double radius_b) {
    const float reach = std::max(0.0f, frame.pruneReach(clearance + radius_a + radius_b));
    return reach * reach * (1.0f + kSphereMargin);
  };
  // Bounds by the largest and the smallest balls decide most pairs.
  const float farthest_of_all = farthest(a.largestRadius(), b.largestRadius());
  const float surely_of_all = ballHit(frame, least, a.smallestRadius(), b.smallestRadius());
  alignas(64) float squared[kLeafPoints];
  for (std::uint32_t j = 0; j < b.count; ++j) {
    squaredDistances(points, b.x()[j], b.y()[j], b.z()[j], squared);
    for (const std::uint32_t i : Bits(lanes & ~above(squared, farthest_of_all))) {
      bool surely = squared[i] <= surely_of_all;
      if (!surely) {
        if (squared[i] > farthest(a.radius(i), b.radius(j))) continue;
        surely = squared[i] <= ballHit(frame, least, a.radius(i), b.radius(j));
      }
      if (found(i, j, squared[i], surely)) return true;
    }
  }
  return false;
}

/// Two leaves whose points are compared.
struct ComparedLeaves {
  ComparedLeaves(const LeafRange& of_a, const LeafRange& of_b, const RelativeFrame& between, double unit_of_b)
  : a(of_a),
    b(of_b),
    frame(between),
    unit(unit_of_b),
    near(firstBits(a.count))
  {
    carryLeaf(frame, a, points);
  }

  LeafRange a, b;
  const RelativeFrame& frame;
  double unit;        ///< of the frame's lengths, in the clouds' unit
  std::uint32_t near; ///< bits of a's points that may be near b's
  LeafPoints points;  ///< a's, in the frame
};

/// Calls found(i, j) for pairs that may be the nearest of all and no farther apart than `to_beat`. The smallest float
/// distance leaves out the others. Stops when found() returns true.
/// @param to_beat in the clouds' unit; below 0 only where points have radii
template <class Found>
void eachPairMaybeNearest(const ComparedLeaves& leaves, bool have_radii, double to_beat, const Found& found)
{
  const LeafRange &a = leaves.a, &b = leaves.b;
  if (have_radii) {
    eachBallPairNear(leaves.frame, leaves.points, firstBits(a.count), a, b, to_beat,
                     -std::numeric_limits<double>::infinity(),
                     [&](std::uint32_t i, std::uint32_t j, float, bool) { return found(i, j); });
    return;
  }
  alignas(64) float nearest[kLeafPoints];
  std::fill(std::begin(nearest), std::end(nearest), std::numeric_limits<float>::infinity());
  nearestSquared(leaves.points, b.x(), b.y(), b.z(), firstBits(b.count), nearest);
  const float least = *std::min_element(nearest, nearest + a.count);
  const double within =
      (lengthOver(least) + leaves.frame.error) * (1.0 + leaves.frame.skew()) * (1.0 + kDoubleMargin) * leaves.unit;
  to_beat = std::max(to_beat, 0.0);
  const float miss = leaves.frame.band(std::isnan(within) ? to_beat : std::min(within, to_beat)).miss;
  const std::uint32_t lanes = firstBits(a.count) & ~above(nearest, miss);
  if (lanes != 0)
    eachPairNotBeyond(leaves.points, lanes, b, miss,
                      [&](std::uint32_t i, std::uint32_t j, float) { return found(i, j); });
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
