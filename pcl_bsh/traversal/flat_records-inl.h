// SPDX-License-Identifier: BSD-3-Clause
// Lays triangles of b flat in the frames of their voxels as a walk comes near to them, and compares nodes of a with
// them. A thin triangle is much smaller than its ball.

#if defined(PCL_BSH_TRAVERSAL_FLAT_RECORDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAVERSAL_FLAT_RECORDS_INL_H_
#undef PCL_BSH_TRAVERSAL_FLAT_RECORDS_INL_H_
#else
#define PCL_BSH_TRAVERSAL_FLAT_RECORDS_INL_H_
#endif

#include <pcl_bsh/geometry/triangle/flat_triangle.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/simd/triangle_lanes-inl.h>
#include <pcl_bsh/simd/triangle_pair_lanes-inl.h>
#include <pcl_bsh/traversal/leaf_pair-inl.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// A leaf's triangles are compared with a node when the leaf's largest ball is more than this many times as large.
inline constexpr double kLargeBall = 2.0;

/// A triangle, laid flat in the frame of its voxel.
struct FlatRecord {
  std::uint32_t record = kNoRecord;
  double reach = 0.0; ///< of its corners; may exceed the reach of the frame
  FlatTriangle<float> flat;

  static constexpr std::uint32_t kNoRecord = 0xffffffffu;

  static FlatRecord of(const LocalFrame& frame, std::uint32_t record, const Triangle3& corners)
  {
    FlatRecord flat{record, 0.0, flatten(frame, corners)};
    for (const Point3& corner : corners) {
      double sum = 0.0;
      for (std::size_t k = 0; k < 3; ++k) sum += std::abs(corner[k] - frame.origin[k]) / frame.unit;
      flat.reach = std::max(flat.reach, sum);
    }
    return flat;
  }

  /// Returns the triangle's error beside that of stored points, in the voxel's unit. A frame's own error counts the
  /// skew of the poses only within the frame's reach, and corners may lie beyond it.
  double error(const RelativeFrame& frame) const { return double{flat.error} + 2 * frame.skew() * reach; }

  /// Whether error() is at most the frame's error of points.
  bool isUsual(const RelativeFrame& frame) const { return error(frame) <= frame.error; }

  /// The band of a length for all usual triangles. It leaves a little more undecided than band(), but is computed once.
  static DistanceBand usualBand(const RelativeFrame& frame, double length)
  {
    return frame.band(length, frame.error, kFlatShare);
  }

  /// The band of this triangle for a length in the clouds' unit.
  DistanceBand band(const RelativeFrame& frame, double length) const
  {
    return frame.band(length, error(frame), kFlatShare);
  }
};

/// A cache of one cloud's flat triangles in the order of its leaves, so that the triangles of a leaf lie together.
class FlatRecords {
public:
  /// Call before a walk: forgets the triangles of another cloud.
  void prepare(const SphereHierarchy::Storage& cloud)
  {
    if (!cloud.view.triangles || cloud.revision == revision_) return;
    slots_.assign(std::bit_ceil(std::clamp<std::size_t>(cloud.size, 2, kMostSlots)), FlatRecord());
    revision_ = cloud.revision;
  }

  /// Returns record i of a leaf, laid flat. Valid until the next call.
  const FlatRecord& of(const PointsView& view, const LeafRange& leaf, std::uint32_t i)
  {
    const std::uint32_t record = leaf.record(i);
    FlatRecord& slot = slots_[(leaf.voxel->begin + leaf.begin + i) & (slots_.size() - 1)];
    if (slot.record == record) return slot;
    return slot = FlatRecord::of(leaf.voxel->frame, record, view.triangles->triangle(record));
  }

  std::size_t bytes() const noexcept { return slots_.capacity() * sizeof(FlatRecord); }

private:
  static constexpr std::size_t kMostSlots = 1u << 14;

  std::vector<FlatRecord> slots_; ///< their number is a power of two
  std::uint64_t revision_ = 0;    ///< of the cloud; no cloud has 0
};

/// The triangles of a leaf of a in the frame of a voxel of b.
struct CarriedTriangles {
  LeafCorners leaf;
  double error = 0.0; ///< of corners, to be added to the frame's, in its unit: corners may lie beyond the reach

  /// Length of a carried corner's error, relative to the absolute sum of the corner's coordinates. Storing and carrying
  /// round each coordinate, as RelativeFrame counts.
  static constexpr double kError = 1.7321 * (kStoringError + kCarriedProductError + kFewDoubleRoundings);

  void carry(const PointsView& view, const LeafRange& of_a, const RelativeFrame& frame)
  {
    const LocalFrame& from = of_a.voxel->frame;
    const double inverse = 1.0 / from.unit;
    double reach = 0.0;
    LeafPoints stored[3];
    for (std::uint32_t i = 0; i < of_a.count; ++i) {
      const Triangle3 corners = view.triangles->triangle(of_a.record(i));
      for (std::size_t k = 0; k < 3; ++k) {
        const double x = (corners[k][0] - from.origin[0]) * inverse, y = (corners[k][1] - from.origin[1]) * inverse,
                     z = (corners[k][2] - from.origin[2]) * inverse;
        reach = std::max(reach, std::abs(x) + std::abs(y) + std::abs(z));
        stored[k].x[i] = roundToFloat(x), stored[k].y[i] = roundToFloat(y), stored[k].z[i] = roundToFloat(z);
      }
    }
    for (std::size_t k = 0; k < 3; ++k)
      HWY_NAMESPACE::carry(frame.m.data(), frame.g.data(), stored[k].x, stored[k].y, stored[k].z, of_a.count,
                           leaf.corners[k].x, leaf.corners[k].y, leaf.corners[k].z);
    const double carried = static_cast<double>(frame.stretch_a) * reach;
    error = carried < kLargestCarried / 4 ? kError * carried : std::numeric_limits<double>::infinity();
  }
};

/// Calls found(i, j) for the pairs of two leaves that floats do not prove to be farther apart than reach(), radii of
/// points subtracted. Stops when found() returns true. At least one leaf is of triangles. Beside triangles of a, a
/// point of b counts as a triangle with three equal corners.
/// @param reach returns a length >= 0 in the clouds' unit; called before each record of b
template <class Reach, class Found>
bool eachPairNearTriangles(const ComparedLeaves& leaves, const PointsView& view_a, const PointsView& view_b,
                           FlatRecords& flat, const Reach& reach, const Found& found)
{
  const RelativeFrame& frame = leaves.frame;
  const LocalFrame& frame_b = leaves.b.voxel->frame;
  const double largest = leaves.a.largestRadius();
  CarriedTriangles own;
  FlatRecord point_of_b;
  bool is_carried = false;
  for (std::uint32_t j = 0; j < leaves.b.count; ++j) {
    const float by_balls = frame.pruneReach(reach() + largest + leaves.b.radius(j));
    std::uint32_t near =
        leaves.near & pointsNear(leaves.points.x, leaves.points.y, leaves.points.z, leaves.a.count, leaves.b.x()[j],
                                 leaves.b.y()[j], leaves.b.z()[j], by_balls, kSphereMargin);
    if (near == 0) continue;
    const std::uint32_t record = leaves.b.record(j);
    if (!view_b.triangles) {
      const Point3 at = view_b.point(record);
      point_of_b = FlatRecord::of(frame_b, record, {at, at, at});
    }
    const FlatRecord& triangle = view_b.triangles ? flat.of(view_b, leaves.b, j) : point_of_b;
    const double of_points =
        (view_a.triangles ? 0.0 : largest) + (view_b.triangles ? 0.0 : leaves.b.radius(j)); // radii, not measured
    const double within = reach() + of_points;
    if (view_a.triangles) {
      if (!is_carried) own.carry(view_a, leaves.a, frame);
      is_carried = true;
      const float error = roundUp(own.error + triangle.error(frame));
      near &= ~compareWithTriangle(triangle.flat, own.leaf, near, frame.pruneReach(within) + error, -1.0f).apart;
    }
    else {
      alignas(64) float squared[kLeafPoints];
      squaredToTriangle(triangle.flat, leaves.points.x, leaves.points.y, leaves.points.z, kLeafPoints, squared);
      near &= ~above(squared, triangle.band(frame, within).miss);
    }
    for (const std::uint32_t i : Bits(near))
      if (found(i, j)) return true;
  }
  return false;
}

/// The result of comparing up to eight spheres with triangles, in the frame of a voxel of b: bits of the spheres.
struct LanesNear {
  std::uint32_t near = 0;   ///< spheres that one of the triangles may be near to
  std::uint32_t inside = 0; ///< spheres that are certainly, as wholes, within `sure_reach` of one triangle
};

/// Compares up to eight spheres with triangles.
/// @param x, y, z, r of the spheres, r stretched
/// @param lanes bits of the spheres to compare
/// @param reach spheres farther from a triangle are not near it; the frame's error is added
/// @param sure_reach spheres within it are inside; the frame's error is subtracted; negative: no caller asks
/// @param triangle returns the FlatRecord of number j, below `count`
template <class Triangles>
HWY_NOINLINE LanesNear trianglesNear(const float* x, const float* y, const float* z, const float* r,
                                     std::uint32_t lanes, const RelativeFrame& frame, float reach, float sure_reach,
                                     std::uint32_t count, const Triangles& triangle)
{
  const LaneTag d;
  LanesNear found;
  for (std::uint32_t j = 0; j < count; ++j) {
    const FlatRecord& record = triangle(j);
    alignas(64) float squared[kLanes];
    squaredToTriangle(record.flat, x, y, z, kLanes, squared);
    const float error = roundUp(record.error(frame));
    const LaneVector more = hn::Set(d, 1.0f + kFlatMargin), less = hn::Set(d, 1.0f - kFlatMargin);
    for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
      const LaneVector s = hn::Load(d, squared + i), radius = hn::LoadU(d, r + i);
      const LaneVector limit = hn::Mul(hn::Add(hn::Add(radius, hn::Set(d, reach)), hn::Set(d, error)), more);
      const auto apart = hn::Gt(s, hn::Add(hn::Mul(limit, limit), hn::Set(d, kVanishingSquare)));
      found.near |= (bitsOf(d, hn::Not(apart)) & ((1u << hn::Lanes(d)) - 1)) << i;
      const LaneVector room =
          hn::Mul(hn::Sub(hn::Set(d, sure_reach), hn::Mul(hn::Add(radius, hn::Set(d, error)), more)), less);
      const auto within = hn::And(hn::Gt(room, hn::Zero(d)),
                                  hn::Le(hn::Add(s, hn::Set(d, kVanishingSquare)), hn::Mul(hn::Mul(room, room), less)));
      found.inside |= bitsOf(d, within) << i;
    }
    if ((lanes & ~(sure_reach > 0.0f ? found.inside : found.near)) == 0) break;
  }
  found.near &= lanes;
  found.inside &= lanes;
  return found;
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
