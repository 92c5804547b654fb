// SPDX-License-Identifier: BSD-3-Clause
// A leaf's points, sixteen at most, against another leaf's; and passes over any range of points.

#if defined(PCL_BSH_SIMD_POINT_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_SIMD_POINT_LANES_INL_H_
#undef PCL_BSH_SIMD_POINT_LANES_INL_H_
#else
#define PCL_BSH_SIMD_POINT_LANES_INL_H_
#endif

#include <pcl_bsh/simd/bits.h>
#include <pcl_bsh/simd/slab_lanes-inl.h>

#include <algorithm>
#include <cstdint>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline constexpr std::size_t kLeafPoints = 16; ///< of a leaf, at most

/// The bits of the first `count` of sixteen points.
HWY_INLINE std::uint32_t firstBits(std::size_t count)
{
  return (1u << count) - 1;
}

/// Sixteen points in one frame; those past the leaf's count hold anything.
struct LeafPoints {
  alignas(64) float x[kLeafPoints];
  alignas(64) float y[kLeafPoints];
  alignas(64) float z[kLeafPoints];
};

/// Which of a leaf's `count` points are not proven to be farther than reach from (cx, cy, cz); sixteen are read.
HWY_INLINE std::uint32_t pointsNear(const float* x, const float* y, const float* z, std::size_t count, float cx,
                                    float cy, float cz, float reach, float margin)
{
  const LaneTag d;
  const LaneVector limit = hn::Set(d, reach * reach * (1.0f + margin));
  std::uint32_t far = 0;
  for (std::size_t i = 0; i < kLeafPoints; i += hn::Lanes(d)) {
    const LaneVector dx = hn::Sub(hn::LoadU(d, x + i), hn::Set(d, cx));
    const LaneVector dy = hn::Sub(hn::LoadU(d, y + i), hn::Set(d, cy));
    const LaneVector dz = hn::Sub(hn::LoadU(d, z + i), hn::Set(d, cz));
    far |= bitsOf(d, hn::Gt(squaredNorm(dx, dy, dz), limit)) << i;
  }
  return ~far & firstBits(count);
}

/// A lower bound of the distance from a leaf's `count` points to a slab, by how far the slab's points reach towards
/// each; sixteen are read. 0 where no gap is known, as in slabGaps().
HWY_INLINE float pointsGap(const float* x, const float* y, const float* z, std::size_t count, const Slab& slab)
{
  const LaneTag d;
  const LaneVector nx = hn::Set(d, slab.normal.x), ny = hn::Set(d, slab.normal.y), nz = hn::Set(d, slab.normal.z);
  const LaneVector h = hn::Set(d, slab.h), r = hn::Set(d, slab.radius);
  LaneVector least = hn::Set(d, std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const LaneVector dx = hn::Sub(hn::LoadU(d, x + i), hn::Set(d, slab.center.x));
    const LaneVector dy = hn::Sub(hn::LoadU(d, y + i), hn::Set(d, slab.center.y));
    const LaneVector dz = hn::Sub(hn::LoadU(d, z + i), hn::Set(d, slab.center.z));
    const LaneVector on = FacingSlabs::dot(nx, ny, nz, dx, dy, dz);
    const LaneVector rest =
        hn::Sqrt(squaredNorm(hn::Sub(dx, hn::Mul(on, nx)), hn::Sub(dy, hn::Mul(on, ny)), hn::Sub(dz, hn::Mul(on, nz))));
    const LaneVector length = hn::Sqrt(squaredNorm(dx, dy, dz));
    const LaneVector support = hn::Div(FacingSlabs::supportTimesLength(d, on, h, rest, r), length);
    const LaneVector gap = hn::Sub(hn::Sub(length, support), FacingSlabs::supportMargin(d, length, r));
    // A point in the centre has no distance to divide by, and squares may overflow: then nothing is known.
    const LaneVector known = hn::IfThenElseZero(hn::IsFinite(gap), gap);
    least = hn::Min(least, hn::IfThenElse(hn::FirstN(d, count - i), known, least));
  }
  return hn::GetLane(hn::MinOfLanes(d, least));
}

/// Which of sixteen points are not proven to be farther than reach from the box [low, high]; the arrays go on that far.
HWY_INLINE std::uint32_t pointsNearBox(const float* x, const float* y, const float* z, const float* low,
                                       const float* high, float reach, float margin)
{
  const LaneTag d;
  const LaneVector limit = hn::Set(d, reach * reach * (1.0f + margin));
  const auto outside = [d](const float* at, float least, float most) {
    const LaneVector value = hn::LoadU(d, at);
    return hn::Max(hn::Max(hn::Sub(hn::Set(d, least), value), hn::Sub(value, hn::Set(d, most))), hn::Zero(d));
  };
  std::uint32_t far = 0;
  for (std::size_t i = 0; i < kLeafPoints; i += hn::Lanes(d)) {
    const LaneVector dx = outside(x + i, low[0], high[0]);
    const LaneVector dy = outside(y + i, low[1], high[1]);
    const LaneVector dz = outside(z + i, low[2], high[2]);
    far |= bitsOf(d, hn::Gt(squaredNorm(dx, dy, dz), limit)) << i;
  }
  return ~far & firstBits(kLeafPoints);
}

/// Lowers nearest[i] to the smallest squared distance of point i to those points (x, y, z) that have their bit set;
/// none may be NaN where the result is used.
HWY_INLINE void nearestSquared(const LeafPoints& points, const float* x, const float* y, const float* z,
                               std::uint32_t others, float* nearest)
{
  const LaneTag d;
  for (std::size_t i = 0; i < kLeafPoints; i += 2 * hn::Lanes(d)) {
    const std::size_t k = i + hn::Lanes(d);
    const LaneVector ax = hn::Load(d, points.x + i), ay = hn::Load(d, points.y + i), az = hn::Load(d, points.z + i);
    const LaneVector bx = hn::Load(d, points.x + k), by = hn::Load(d, points.y + k), bz = hn::Load(d, points.z + k);
    LaneVector best_a = hn::LoadU(d, nearest + i), best_b = hn::LoadU(d, nearest + k);
    for (const std::uint32_t j : Bits(others)) {
      const LaneVector qx = hn::Set(d, x[j]), qy = hn::Set(d, y[j]), qz = hn::Set(d, z[j]);
      best_a = hn::Min(best_a, squaredNorm(hn::Sub(ax, qx), hn::Sub(ay, qy), hn::Sub(az, qz)));
      best_b = hn::Min(best_b, squaredNorm(hn::Sub(bx, qx), hn::Sub(by, qy), hn::Sub(bz, qz)));
    }
    hn::StoreU(best_a, d, nearest + i);
    hn::StoreU(best_b, d, nearest + k);
  }
}

/// For each of sixteen points, the nearest of other points so far, and how near the second nearest is.
struct NearestTwo {
  alignas(64) float first[kLeafPoints];
  alignas(64) float second[kLeafPoints];
  alignas(64) std::int32_t name[kLeafPoints]; ///< of the first

  HWY_INLINE void clear()
  {
    const LaneTag d;
    const hn::RebindToSigned<LaneTag> di;
    for (std::size_t i = 0; i < kLeafPoints; i += hn::Lanes(d)) {
      hn::Store(hn::Set(d, std::numeric_limits<float>::infinity()), d, first + i);
      hn::Store(hn::Set(d, std::numeric_limits<float>::infinity()), d, second + i);
      hn::Store(hn::Set(di, -1), di, name + i);
    }
  }
};

/// Updates the nearest two of each of sixteen points by the points (x, y, z) whose bit is set in `others`. Only vectors
/// that have a bit in `points_near` take part; point j is called name + j. Compares squared distances; with radii,
/// distances less the other point's radius times `scale`. None may be NaN where the result is used.
/// @tparam kBalls whether there are radii
template <bool kBalls>
HWY_INLINE void takeNearestTwo(const LeafPoints& points, std::uint32_t points_near, const float* x, const float* y,
                               const float* z, const float* radii, float scale, std::uint32_t others, std::int32_t name,
                               NearestTwo& nearest)
{
  const LaneTag d;
  const hn::RebindToSigned<LaneTag> di;
  struct Some {
    LaneVector px, py, pz, first, second;
    hn::Vec<decltype(di)> names;

    HWY_INLINE Some(const LeafPoints& points, const NearestTwo& nearest, std::size_t i)
    : px(hn::Load(LaneTag(), points.x + i)),
      py(hn::Load(LaneTag(), points.y + i)),
      pz(hn::Load(LaneTag(), points.z + i)),
      first(hn::Load(LaneTag(), nearest.first + i)),
      second(hn::Load(LaneTag(), nearest.second + i)),
      names(hn::Load(hn::RebindToSigned<LaneTag>(), nearest.name + i))
    {
    }
    HWY_INLINE void take(LaneVector qx, LaneVector qy, LaneVector qz, LaneVector less, hn::Vec<decltype(di)> named)
    {
      LaneVector value = squaredNorm(hn::Sub(px, qx), hn::Sub(py, qy), hn::Sub(pz, qz));
      if constexpr (kBalls) value = hn::Sub(hn::Sqrt(value), less);
      (void)less;
      names = hn::IfThenElse(hn::RebindMask(hn::RebindToSigned<LaneTag>(), hn::Lt(value, first)), named, names);
      second = hn::Min(second, hn::Max(first, value));
      first = hn::Min(first, value);
    }
    HWY_INLINE void store(NearestTwo& nearest, std::size_t i) const
    {
      hn::Store(first, LaneTag(), nearest.first + i);
      hn::Store(second, LaneTag(), nearest.second + i);
      hn::Store(names, hn::RebindToSigned<LaneTag>(), nearest.name + i);
    }
  };
  const auto each = [&](const auto& take) HWY_ATTR {
    for (const std::uint32_t j : Bits(others)) {
      take(hn::Set(d, x[j]), hn::Set(d, y[j]), hn::Set(d, z[j]), kBalls ? hn::Set(d, radii[j] * scale) : hn::Zero(d),
           hn::Set(di, name + static_cast<std::int32_t>(j)));
    }
  };
  constexpr std::size_t step = hn::MaxLanes(LaneTag());
  for (std::size_t i = 0; i < kLeafPoints; i += 2 * step) {
    const std::uint32_t here = points_near >> i, next = here >> step;
    if ((here & firstBits(step)) != 0 && (next & firstBits(step)) != 0) {
      Some one(points, nearest, i), two(points, nearest, i + step);
      each([&](auto... values) HWY_ATTR {
        one.take(values...);
        two.take(values...);
      });
      one.store(nearest, i);
      two.store(nearest, i + step);
    }
    else if ((here & firstBits(2 * step)) != 0) {
      const std::size_t k = (here & firstBits(step)) != 0 ? i : i + step;
      Some one(points, nearest, k);
      each([&](auto... values) HWY_ATTR { one.take(values...); });
      one.store(nearest, k);
    }
  }
}

/// Which of sixteen values are at most `limit`.
HWY_INLINE std::uint32_t atMost(const float* values, float limit)
{
  const LaneTag d;
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < kLeafPoints; i += hn::Lanes(d))
    bits |= bitsOf(d, hn::Le(hn::Load(d, values + i), hn::Set(d, limit))) << i;
  return bits;
}

/// Bit i: values[i] is at most limits[i]; aboveEach(): it is above.
HWY_INLINE std::uint32_t atMostEach(const float* values, const float* limits)
{
  const LaneTag d;
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < kLeafPoints; i += hn::Lanes(d))
    bits |= bitsOf(d, hn::Le(hn::Load(d, values + i), hn::Load(d, limits + i))) << i;
  return bits;
}
HWY_INLINE std::uint32_t aboveEach(const float* values, const float* limits)
{
  const LaneTag d;
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < kLeafPoints; i += hn::Lanes(d))
    bits |= bitsOf(d, hn::Gt(hn::Load(d, values + i), hn::Load(d, limits + i))) << i;
  return bits;
}

/// Which of sixteen values are above `limit`. Not the opposite of atMost(): NaN is neither.
HWY_INLINE std::uint32_t above(const float* values, float limit)
{
  const LaneTag d;
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < kLeafPoints; i += hn::Lanes(d))
    bits |= bitsOf(d, hn::Gt(hn::Load(d, values + i), hn::Set(d, limit))) << i;
  return bits;
}

/// Squared distances of the sixteen points to (qx, qy, qz).
HWY_INLINE void squaredDistances(const LeafPoints& points, float qx, float qy, float qz, float* squared)
{
  const LaneTag d;
  for (std::size_t i = 0; i < kLeafPoints; i += hn::Lanes(d)) {
    const LaneVector dx = hn::Sub(hn::Load(d, points.x + i), hn::Set(d, qx));
    const LaneVector dy = hn::Sub(hn::Load(d, points.y + i), hn::Set(d, qy));
    const LaneVector dz = hn::Sub(hn::Load(d, points.z + i), hn::Set(d, qz));
    hn::StoreU(squaredNorm(dx, dy, dz), d, squared + i);
  }
}

/// Whether one of `count` points is surely within reach > 0 of (cx, cy, cz). Reads whole vectors, as farthestSquared()
/// does.
HWY_INLINE bool anyPointWithin(const float* x, const float* y, const float* z, std::size_t count, float cx, float cy,
                               float cz, float reach)
{
  const LaneTag d;
  const LaneVector vx = hn::Set(d, cx), vy = hn::Set(d, cy), vz = hn::Set(d, cz);
  const LaneVector limit = hn::Set(d, reach * reach * (1.0f - kSphereMargin) - kVanishingSquare);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const LaneVector squared = squaredNorm(hn::Sub(hn::LoadU(d, x + i), vx), hn::Sub(hn::LoadU(d, y + i), vy),
                                           hn::Sub(hn::LoadU(d, z + i), vz));
    const std::uint32_t within = bitsOf(d, hn::Le(squared, limit));
    if ((within & firstBits(std::min(count - i, hn::Lanes(d)))) != 0) return true;
  }
  return false;
}

/// Whether any point is within a reach of its own: reach + scale * lengths[i]; a negative reach holds no point.
/// @param reach rounded inward, and scale so that the products are. @param lengths >= 0; as many are read as of x
HWY_INLINE bool anyPointWithinEach(const float* x, const float* y, const float* z, const float* lengths, float scale,
                                   std::size_t count, const Point& to, float reach)
{
  const LaneTag d;
  const LaneVector vx = hn::Set(d, to.x), vy = hn::Set(d, to.y), vz = hn::Set(d, to.z);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const LaneVector squared = squaredNorm(hn::Sub(hn::LoadU(d, x + i), vx), hn::Sub(hn::LoadU(d, y + i), vy),
                                           hn::Sub(hn::LoadU(d, z + i), vz));
    const LaneVector room = hn::Add(hn::Set(d, reach), hn::Mul(hn::LoadU(d, lengths + i), hn::Set(d, scale)));
    const LaneVector core =
        hn::Sub(hn::Mul(hn::Mul(room, room), hn::Set(d, 1.0f - kSphereMargin)), hn::Set(d, kVanishingSquare));
    const std::uint32_t within = bitsOf(d, hn::And(hn::Gt(room, hn::Zero(d)), hn::Le(squared, core)));
    if ((within & firstBits(std::min(count - i, hn::Lanes(d)))) != 0) return true;
  }
  return false;
}

/// Lowers longer[i] to the smallest distance of point i to those points (x, y, z) that have their bit set, each plus
/// scale * lengths[j], and shorter[i] to the smallest less that. Both in float arithmetic: kReachMargin of all terms.
HWY_INLINE void nearestWithLengths(const LeafPoints& points, const float* x, const float* y, const float* z,
                                   const float* lengths, float scale, std::uint32_t others, float* longer,
                                   float* shorter)
{
  const LaneTag d;
  for (std::size_t i = 0; i < kLeafPoints; i += hn::Lanes(d)) {
    const LaneVector px = hn::Load(d, points.x + i), py = hn::Load(d, points.y + i), pz = hn::Load(d, points.z + i);
    LaneVector least = hn::Load(d, longer + i), most = hn::Load(d, shorter + i);
    for (const std::uint32_t j : Bits(others)) {
      const LaneVector distance = hn::Sqrt(
          squaredNorm(hn::Sub(px, hn::Set(d, x[j])), hn::Sub(py, hn::Set(d, y[j])), hn::Sub(pz, hn::Set(d, z[j]))));
      const LaneVector length = hn::Set(d, lengths[j] * scale);
      least = hn::Min(least, hn::Add(distance, length));
      most = hn::Min(most, hn::Sub(distance, length));
    }
    hn::Store(least, d, longer + i);
    hn::Store(most, d, shorter + i);
  }
}

/// Largest squared distance of count > 0 points from (cx, cy, cz), in float arithmetic (kSquaredDistanceError).
/// Reads whole vectors: the arrays must go on that far.
HWY_INLINE float farthestSquared(const float* x, const float* y, const float* z, std::size_t count, float cx, float cy,
                                 float cz)
{
  const LaneTag d;
  const LaneVector vx = hn::Set(d, cx), vy = hn::Set(d, cy), vz = hn::Set(d, cz);
  LaneVector most = hn::Zero(d);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const LaneVector squared = squaredNorm(hn::Sub(hn::LoadU(d, x + i), vx), hn::Sub(hn::LoadU(d, y + i), vy),
                                           hn::Sub(hn::LoadU(d, z + i), vz));
    most = hn::Max(most, hn::IfThenElseZero(hn::FirstN(d, std::min(count - i, hn::Lanes(d))), squared));
  }
  return hn::GetLane(hn::MaxOfLanes(d, most));
}

/// Squared distances of a leaf's points to (qx, qy, qz), sixteen of them whatever the leaf's count: the arrays go on
/// that far.
HWY_INLINE void leafSquaredDistances(const float* x, const float* y, const float* z, float qx, float qy, float qz,
                                     float* squared)
{
  const LaneTag d;
  for (std::size_t i = 0; i < kLeafPoints; i += hn::Lanes(d)) {
    const LaneVector dx = hn::Sub(hn::LoadU(d, x + i), hn::Set(d, qx));
    const LaneVector dy = hn::Sub(hn::LoadU(d, y + i), hn::Set(d, qy));
    const LaneVector dz = hn::Sub(hn::LoadU(d, z + i), hn::Set(d, qz));
    hn::Store(squaredNorm(dx, dy, dz), d, squared + i);
  }
}

/// Largest of `count` > 0 values.
HWY_INLINE float largestOf(const float* values, std::size_t count)
{
  const LaneTag d;
  const std::size_t step = hn::Lanes(d);
  LaneVector most = hn::Set(d, values[0]);
  std::size_t i = 0;
  for (; i + step <= count; i += step) most = hn::Max(most, hn::LoadU(d, values + i));
  float largest = hn::GetLane(hn::MaxOfLanes(d, most));
  for (; i < count; ++i) largest = std::max(largest, values[i]);
  return largest;
}

/// Smallest of `count` > 0 values.
HWY_INLINE float smallestOf(const float* values, std::size_t count)
{
  const LaneTag d;
  const std::size_t step = hn::Lanes(d);
  LaneVector least = hn::Set(d, values[0]);
  std::size_t i = 0;
  for (; i + step <= count; i += step) least = hn::Min(least, hn::LoadU(d, values + i));
  float smallest = hn::GetLane(hn::MinOfLanes(d, least));
  for (; i < count; ++i) smallest = std::min(smallest, values[i]);
  return smallest;
}

/// How many of `count` values are at most `limit`.
HWY_INLINE std::size_t countAtMost(const float* values, std::size_t count, float limit)
{
  const LaneTag d;
  const std::size_t step = hn::Lanes(d);
  std::size_t found = 0, i = 0;
  for (; i + step <= count; i += step) found += hn::CountTrue(d, hn::Le(hn::LoadU(d, values + i), hn::Set(d, limit)));
  for (; i < count; ++i) found += values[i] <= limit ? 1 : 0;
  return found;
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
