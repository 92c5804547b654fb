// SPDX-License-Identifier: BSD-3-Clause
// Bounds of the distances from the children of a node of a to spheres, slabs and triangles of b, eight at once. They
// are floats in one unit for all frames, rounded outward.

#if defined(PCL_BSH_DISTANCES_BOUNDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_DISTANCES_BOUNDS_INL_H_
#undef PCL_BSH_DISTANCES_BOUNDS_INL_H_
#else
#define PCL_BSH_DISTANCES_BOUNDS_INL_H_
#endif

#include <pcl_bsh/distances/bound_margin.h>
#include <pcl_bsh/geometry/triangle/flat_triangle.h>
#include <pcl_bsh/simd/crossed_lanes-inl.h>
#include <pcl_bsh/traversal/list_walk-inl.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// A space of b, as seen from a voxel of a.
struct DistanceObstacle {
  const Voxel* voxel;                 ///< null: the tree above the voxels
  std::uint32_t space = kAboveVoxels; ///< the voxel's number, where the walk has entered it
  RelativeFrame frame;
  float slack;                        ///< pruneReach(0): what floats may err by
  float blunt_radius;                 ///< as the frame has it
  float error;                        ///< of carried points, at least
  float least, most;                  ///< lower and upper bound of a length of 1 in the frame, in the walk's unit
  float at_most_inside;               ///< upper bound of a length of 1 in the walk's unit, in the frame
  float normal_scale;                 ///< factor that makes normals carried into the frame of length 1
  bool is_plain;                      ///< whether float distances in the frame can be compared with those in others
  const Slabs* slabs = nullptr;       ///< of the voxel's nodes, where it has triangles
  const Slabs* cross_slabs = nullptr; ///< second slabs of the nodes, where the triangles are long

  /// @param unit of the walk, in the clouds' unit @param unit_a of a's voxel
  DistanceObstacle(const Voxel* entered, const LocalFrame& in, const RelativeFrame& from_a, double unit, double unit_a)
  : voxel(entered),
    frame(from_a),
    slack(frame.pruneReach(0.0)),
    blunt_radius(frame.bluntRadius()),
    error(roundUp(frame.error))
  {
    constexpr double smallest = 0x1p-60, largest = 0x1p60; // factors beyond are given up: no bound is as good
    const double ratio = in.unit / unit, margin = 2 * frame.skew() + kDoubleMargin;
    least = ratio < smallest ? 0.0f : roundDown(std::min(ratio, largest) * (1.0 - margin));
    most = roundUp(std::max(ratio, smallest) * (1.0 + margin));
    at_most_inside = roundUp(std::max(1.0 / ratio, smallest) * (1.0 + margin));
    const double from_unit_a = in.unit / unit_a; // a power of 2; normals of 0 tell nothing
    normal_scale = from_unit_a > smallest && from_unit_a < largest ? static_cast<float>(from_unit_a) : 0.0f;
    is_plain = ratio == 1.0 && frame.error < std::numeric_limits<double>::infinity();
  }

  /// The slabs of a sphere of the voxel, which hold its records. @pre it has slabs
  CrossedSlabs slabsOf(const ObstacleSphere& sphere) const
  {
    return sphere.between(*voxel, slabs, cross_slabs, frame.stretch_b);
  }
};

/// The children of a node of a in the frame of an obstacle.
struct CarriedNode {
  std::uint64_t stamp = 0; ///< of the visit it was carried for
  float x[kLanes], y[kLanes], z[kLanes], r[kLanes];
  Point center; ///< of the sphere around them all
  float radius;
  std::uint64_t slabs_stamp = 0; ///< of the visit that the following were carried for: what is not far needs none
  float nx[kLanes], ny[kLanes], nz[kLanes], h[kLanes];
};

/// Carries the slabs of a node into the frame, and adds them to its carried children.
HWY_INLINE void carrySlabs(const DistanceObstacle& obstacle, const Slabs& slabs, CarriedNode& own)
{
  carry(obstacle.frame.m.data(), kNowhere, slabs.x, slabs.y, slabs.z, kLanes, own.nx, own.ny, own.nz);
  for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
    for (float* const normal : {own.nx, own.ny, own.nz}) normal[lane] *= obstacle.normal_scale;
    own.h[lane] = slabs.h[lane] * obstacle.frame.stretch_a;
  }
}

/// A lower bound that is NaN bounds nothing.
HWY_INLINE float orNone(float lower)
{
  return std::isnan(lower) ? -std::numeric_limits<float>::infinity() : lower;
}
HWY_INLINE LaneVector orNone(LaneVector lower)
{
  return hn::IfThenElse(hn::Eq(lower, lower), lower, hn::Set(LaneTag(), -std::numeric_limits<float>::infinity()));
}

/// Converts a lower bound of a length in the frame into one in the walk's unit. It may be above 0 or below.
template <class Vector>
HWY_INLINE Vector atLeast(const DistanceObstacle& obstacle, Vector near)
{
  const hn::DFromV<Vector> d;
  return hn::Min(hn::Mul(near, hn::Set(d, obstacle.least)), hn::Mul(near, hn::Set(d, obstacle.most)));
}

/// Sets lower bounds of the distances from each of eight spheres to one other. Lowers each `cut` to an upper bound of
/// the distances from any point of that sphere to its nearest one in the other.
///
/// In the frame, centres are sqrt(s) apart within its error, which slack includes. kBoundMargin covers what
/// rounding takes (test/proof/distances.g). Squares that overflow stand for lengths above 2^63. NaN bounds nothing.
/// @param radius of the other, stretched
HWY_INLINE void boundDistances(const CarriedNode& spheres, const DistanceObstacle& obstacle, const Point& center,
                               float radius, float* lower, float* cut)
{
  const LaneTag d;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
    const LaneVector between = hn::Sqrt(squaredNorm(hn::Sub(hn::LoadU(d, spheres.x + i), hn::Set(d, center.x)),
                                                    hn::Sub(hn::LoadU(d, spheres.y + i), hn::Set(d, center.y)),
                                                    hn::Sub(hn::LoadU(d, spheres.z + i), hn::Set(d, center.z))));
    const LaneVector radii = hn::Add(hn::LoadU(d, spheres.r + i), hn::Set(d, radius + obstacle.slack));
    const LaneVector margin = hn::Mul(hn::Add(between, radii), hn::Set(d, kBoundMargin));
    const LaneVector near = hn::Sub(hn::Sub(hn::Min(between, hn::Set(d, 0x1p63f)), radii), margin);
    const LaneVector far = hn::Add(hn::Add(between, radii), margin);
    hn::StoreU(atLeast(obstacle, near), d, lower + i);
    const LaneVector upper = hn::Mul(far, hn::Set(d, obstacle.most)), old = hn::LoadU(d, cut + i);
    hn::StoreU(hn::IfThenElse(hn::Lt(upper, old), upper, old), d, cut + i);
  }
}

/// Lower bounds of lengths from places in a frame to what lies both in a sphere and in its slabs. As slabsApart() has
/// it: kSlabMargin of all lengths pays for the normals and for float arithmetic. 0 where squares may leave the range of
/// float.
HWY_INLINE LaneVector lengthToSlabs(const CrossedSlabs& slab, LaneVector x, LaneVector y, LaneVector z)
{
  const LaneTag d;
  const LaneVector dx = hn::Sub(x, hn::Set(d, slab.center.x)), dy = hn::Sub(y, hn::Set(d, slab.center.y)),
                   dz = hn::Sub(z, hn::Set(d, slab.center.z));
  const LaneVector nx = hn::Set(d, slab.normal.x), ny = hn::Set(d, slab.normal.y), nz = hn::Set(d, slab.normal.z);
  const LaneVector on = hn::Add(hn::Add(hn::Mul(dx, nx), hn::Mul(dy, ny)), hn::Mul(dz, nz));
  const LaneVector tx = hn::Sub(dx, hn::Mul(on, nx)), ty = hn::Sub(dy, hn::Mul(on, ny)),
                   tz = hn::Sub(dz, hn::Mul(on, nz));
  const LaneVector lengths = hn::Add(hn::Add(hn::Add(hn::Abs(dx), hn::Abs(dy)), hn::Abs(dz)), hn::Set(d, slab.radius));
  const LaneVector margin = hn::Mul(lengths, hn::Set(d, kSlabMargin));
  const LaneVector along = hn::Max(hn::Sub(hn::Abs(on), hn::Add(hn::Set(d, slab.h), margin)), hn::Zero(d));
  const LaneVector across =
      hn::Max(hn::Sub(hn::Sqrt(squaredNorm(tx, ty, tz)), hn::Add(hn::Set(d, slab.radius), margin)), hn::Zero(d));
  const LaneVector squared =
      hn::Max(hn::Add(hn::Mul(along, along), hn::Mul(across, across)), squaredToSlabs(slab, dx, dy, dz, margin));
  return hn::IfThenElseZero(hn::Lt(lengths, hn::Set(d, kLongestOfSlabs)),
                            hn::Mul(hn::Sqrt(squared), hn::Set(d, 1.0f - kBoundMargin)));
}

/// Raises lower bounds as boundDistances() has them by lengths in the frame, less `radii`.
HWY_INLINE void raise(const DistanceObstacle& obstacle, LaneVector length, LaneVector radii, float* lower)
{
  const LaneTag d;
  const LaneVector near = hn::Sub(hn::Sub(length, radii), hn::Mul(hn::Add(length, radii), hn::Set(d, kBoundMargin)));
  const LaneVector scaled = atLeast(obstacle, near);
  const LaneVector before = hn::LoadU(d, lower);
  hn::StoreU(hn::IfThenElse(hn::Gt(scaled, before), scaled, before), d, lower);
}

/// Raises such bounds by the slabs of the other sphere.
HWY_INLINE void raiseBySlabs(const CarriedNode& spheres, const DistanceObstacle& obstacle, const CrossedSlabs& slabs,
                             float* lower)
{
  const LaneTag d;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d))
    raise(obstacle,
          lengthToSlabs(slabs, hn::LoadU(d, spheres.x + i), hn::LoadU(d, spheres.y + i), hn::LoadU(d, spheres.z + i)),
          hn::Add(hn::LoadU(d, spheres.r + i), hn::Set(d, obstacle.slack)), lower + i);
}

/// Whether the farthest child is more than eight radii from a sphere of b, by its lower bound. Slabs of nearer ones
/// cost more time than they spare.
inline bool isFar(const float* lower, std::uint32_t count, float radius)
{
  return *std::max_element(lower, lower + count) > 8.0f * radius;
}

/// Raises such bounds by the slabs of both. Surfaces that face each other from far away are near only where they are
/// opposite.
HWY_INLINE void raiseByBothSlabs(const CarriedNode& own, const DistanceObstacle& obstacle, const Slab& other,
                                 float* lower)
{
  const LaneTag d;
  alignas(32) float gaps[kLanes];
  slabGaps({own.x, own.y, own.z, own.r, 1.0f}, {own.nx, own.ny, own.nz, own.h}, other, gaps);
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d))
    raise(obstacle, hn::Mul(hn::Load(d, gaps + i), hn::Set(d, 1.0f - kSphereMargin)), hn::Set(d, obstacle.slack),
          lower + i);
}

/// Lower bounds of the distances from a box to eight spheres in its frame, as boundDistances() has them; minus infinity
/// where floats tell no bound.
HWY_INLINE void boundFromBox(const SphereLanes& spheres, const DistanceObstacle& obstacle, const float* low,
                             const float* high, float* lower)
{
  const LaneTag d;
  const auto outside = [d](const float* at, float least, float most) HWY_ATTR {
    const LaneVector value = hn::LoadU(d, at);
    return hn::Max(hn::Max(hn::Sub(hn::Set(d, least), value), hn::Sub(value, hn::Set(d, most))), hn::Zero(d));
  };
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
    const LaneVector between =
        hn::Sqrt(squaredNorm(outside(spheres.x + i, low[0], high[0]), outside(spheres.y + i, low[1], high[1]),
                             outside(spheres.z + i, low[2], high[2])));
    const LaneVector radii =
        hn::Add(hn::Mul(hn::LoadU(d, spheres.r + i), hn::Set(d, spheres.stretch)), hn::Set(d, obstacle.slack));
    const LaneVector margin = hn::Mul(hn::Add(between, radii), hn::Set(d, kBoundMargin));
    const LaneVector near = hn::Sub(hn::Sub(hn::Min(between, hn::Set(d, 0x1p63f)), radii), margin);
    hn::StoreU(orNone(atLeast(obstacle, near)), d, lower + i);
  }
}

/// Returns the least of some upper bounds, one for each of up to eight spheres: of the distance from any point of a box
/// to any point of the sphere. The unit is that of boundDistances(). Infinite where floats tell no bound.
HWY_INLINE float farthestFromBox(const SphereLanes& spheres, const DistanceObstacle& obstacle, const float* low,
                                 const float* high, std::uint32_t count)
{
  const LaneTag d;
  const auto corner = [d](const float* at, float least, float most) HWY_ATTR {
    const LaneVector value = hn::LoadU(d, at);
    return hn::Max(hn::Sub(value, hn::Set(d, least)), hn::Sub(hn::Set(d, most), value));
  };
  LaneVector nearest = hn::Set(d, std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const LaneVector between =
        hn::Sqrt(squaredNorm(corner(spheres.x + i, low[0], high[0]), corner(spheres.y + i, low[1], high[1]),
                             corner(spheres.z + i, low[2], high[2])));
    const LaneVector radii =
        hn::Add(hn::Mul(hn::LoadU(d, spheres.r + i), hn::Set(d, spheres.stretch)), hn::Set(d, obstacle.slack));
    const LaneVector sum = hn::Add(between, radii);
    const LaneVector far = hn::Mul(hn::Add(sum, hn::Mul(sum, hn::Set(d, kBoundMargin))), hn::Set(d, obstacle.most));
    nearest = hn::IfThenElse(hn::And(hn::FirstN(d, count - i), hn::Lt(far, nearest)), far, nearest);
  }
  return hn::GetLane(hn::MinOfLanes(d, nearest));
}

/// Which of eight values are not above those of others.
HWY_INLINE std::uint32_t notAbove(const float* values, const float* limits)
{
  const LaneTag d;
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d))
    bits |= bitsOf(d, hn::Gt(hn::LoadU(d, values + i), hn::LoadU(d, limits + i))) << i;
  return bits ^ ((1u << kLanes) - 1);
}

/// Bounds the distances of spheres around eight places from a triangle, in the walk's unit. `low` is for the nearest
/// point of a sphere, `high` for its farthest. @param squared distances of the places, in the obstacle's unit
/// @param error of the triangle and of the carried places, in the obstacle's unit
template <class Tag>
HWY_INLINE void boundsOfFlat(Tag d, hn::Vec<Tag> squared, hn::Vec<Tag> radius, float error,
                             const DistanceObstacle& obstacle, hn::Vec<Tag>& low, hn::Vec<Tag>& high)
{
  const auto length = hn::Sqrt(squared);
  const auto doubt = hn::Mul(hn::Add(hn::Add(length, radius), hn::Set(d, error)), hn::Set(d, kFlatMargin));
  const auto more = hn::Add(doubt, hn::Set(d, error));
  const auto near = hn::Sub(hn::Min(length, hn::Set(d, 0x1p63f)), hn::Add(more, radius));
  low = atLeast(obstacle, near);
  high = hn::Mul(hn::Add(length, more), hn::Set(d, obstacle.most));
  high = hn::Add(high, hn::Mul(radius, hn::Set(d, obstacle.most * (1.0f + 2 * kSphereMargin))));
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
