// SPDX-License-Identifier: BSD-3-Clause
// Squared distances of a voxel's points from one place, as squaredDistanceAsFloat() gives them. Where points are stored
// as they were given, they are read where the search has just been, in vectors, and not in the caller's cloud.

#if defined(PCL_BSH_NEIGHBORS_MEASURE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_NEIGHBORS_MEASURE_INL_H_
#undef PCL_BSH_NEIGHBORS_MEASURE_INL_H_
#else
#define PCL_BSH_NEIGHBORS_MEASURE_INL_H_
#endif

#include <pcl_bsh/geometry/squared_distance.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/simd/compress-inl.h>
#include <pcl_bsh/simd/point_lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// Squared distances of `count` points: coordinate(axis, i) gives coordinates of the i-th and following in double,
/// point(i) a point as it was given. Writes whole vectors.
template <class Coordinate, class PointAt>
HWY_INLINE void measureBy(const Coordinate& coordinate, const PointAt& point, const Point3& place, std::uint32_t count,
                          float* squared)
{
  const hn::CappedTag<double, kLanes> d;
  const hn::Rebind<float, decltype(d)> f;
  const std::uint32_t step = static_cast<std::uint32_t>(hn::Lanes(d));
  for (std::uint32_t i = 0; i < count; i += step) {
    const auto squareOn = [&](std::size_t axis) {
      const auto difference = hn::Sub(coordinate(axis, i), hn::Set(d, place[axis]));
      return hn::Mul(difference, difference);
    };
    const auto sum = hn::Add(hn::Add(squareOn(0), squareOn(1)), squareOn(2));
    const auto below = hn::DemoteTo(f, hn::Mul(sum, hn::Set(d, 1.0 - kFewDoubleRoundings)));
    const auto above = hn::DemoteTo(f, hn::Mul(sum, hn::Set(d, 1.0 + kFewDoubleRoundings)));
    hn::StoreU(below, f, squared + i);
    // 0 is right even where the double underflowed.
    const auto in_range = hn::And(hn::Or(hn::Ge(below, hn::Set(f, 0x1p-100f)), hn::Eq(below, hn::Zero(f))),
                                  hn::Le(below, hn::Set(f, 0x1p100f)));
    if (HWY_LIKELY(hn::AllTrue(f, hn::And(hn::Eq(below, above), in_range)))) continue;
    for (std::uint32_t k = i; k < std::min(i + step, count); ++k) squared[k] = squaredDistanceAsFloat(point(k), place);
  }
}

/// Squared distances of points that a voxel stores as they were given; `local` are their coordinates there.
template <class PointAt>
HWY_INLINE void measureStored(const float* const (&local)[3], const PointAt& point, const Point3& place,
                              const Voxel& voxel, std::uint32_t count, float* squared)
{
  const hn::CappedTag<double, kLanes> d;
  const auto coordinate = [&](std::size_t axis, std::uint32_t i) {
    const hn::Rebind<float, decltype(d)> f;
    return hn::Add(hn::PromoteTo(d, hn::LoadU(f, local[axis] + i)), hn::Set(d, voxel.frame.origin[axis]));
  };
  measureBy(coordinate, point, place, count, squared);
}

/// Squared distances of points read from the caller's cloud.
template <class PointAt>
HWY_INLINE void measureGiven(const PointAt& point, const Point3& place, std::uint32_t count, float* squared)
{
  const hn::CappedTag<double, kLanes> d;
  constexpr std::uint32_t kSome = 16;
  double given[3][kSome] = {};
  for (std::uint32_t from = 0; from < count; from += kSome) {
    const std::uint32_t some = std::min(count - from, kSome);
    for (std::uint32_t i = 0; i < some; ++i) {
      const Point3 p = point(from + i);
      for (std::size_t axis = 0; axis < 3; ++axis) given[axis][i] = p[axis];
    }
    measureBy([&](std::size_t axis, std::uint32_t i) { return hn::LoadU(d, given[axis] + i); },
              [&](std::uint32_t i) { return point(from + i); }, place, some, squared + from);
  }
}

/// Squared distances of points [begin, begin + count); writes whole vectors.
HWY_INLINE void measure(const PointsView& view, const Point3& place, const Voxel& voxel, std::uint32_t begin,
                        std::uint32_t count, float* squared)
{
  const auto point = [&](std::uint32_t i) { return voxel.point(view, begin + i); };
  if (!voxel.frame.lossless) return measureGiven(point, place, count, squared);
  measureStored({voxel.x() + begin, voxel.y() + begin, voxel.z() + begin}, point, place, voxel, count, squared);
}

/// Names and measures the points whose bit is set, among the sixteen from `begin` on. Writes whole vectors.
/// @return how many.
HWY_INLINE std::uint32_t measureSome(const PointsView& view, const Point3& place, const Voxel& voxel,
                                     std::uint32_t begin, std::uint32_t bits, std::uint32_t* records, float* squared)
{
  alignas(64) float local[3][kLeafPoints + kLanes] = {};
  const LaneTag d;
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < kLeafPoints; i += static_cast<std::uint32_t>(hn::Lanes(d))) {
    const std::uint32_t kept = bits >> i & firstBits(hn::Lanes(d));
    const Compress compress(kept);
    compress.store(hn::LoadU(d, voxel.x() + begin + i), local[0] + count);
    compress.store(hn::LoadU(d, voxel.y() + begin + i), local[1] + count);
    compress.store(hn::LoadU(d, voxel.z() + begin + i), local[2] + count);
    compress.store(voxel.records() + begin + i, records + count);
    count += static_cast<std::uint32_t>(std::popcount(kept));
  }
  const auto point = [&](std::uint32_t i) { return view.point(records[i]); };
  if (voxel.frame.lossless)
    measureStored({local[0], local[1], local[2]}, point, place, voxel, count, squared);
  else
    measureGiven(point, place, count, squared);
  return count;
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
