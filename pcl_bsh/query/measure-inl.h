// SPDX-License-Identifier: BSD-3-Clause
// Squared distances of a voxel's points from one place, as squaredDistanceAsFloat() gives them. Where points are stored
// as they were given, they are read where the search has just been, in vectors, and not in the caller's cloud.

#if defined(PCL_BSH_QUERY_MEASURE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_QUERY_MEASURE_INL_H_
#undef PCL_BSH_QUERY_MEASURE_INL_H_
#else
#define PCL_BSH_QUERY_MEASURE_INL_H_
#endif

#include <pcl_bsh/geometry/squared_distance.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/simd/sphere_lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

/// Of points [begin, begin + count), where coordinate(axis, i) gives those of points begin + i and following in double.
/// Writes whole vectors.
template <class Coordinate>
HWY_INLINE void measureBy(const Coordinate& coordinate, const PointsView& view, const Point3& place, const Voxel& voxel,
                          std::uint32_t begin, std::uint32_t count, float* squared)
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
    const auto below = hn::DemoteTo(f, hn::Mul(sum, hn::Set(d, 1.0 - 0x1p-50)));
    const auto above = hn::DemoteTo(f, hn::Mul(sum, hn::Set(d, 1.0 + 0x1p-50)));
    hn::StoreU(below, f, squared + i);
    const auto in_range = hn::And(hn::Ge(below, hn::Set(f, 0x1p-100f)), hn::Le(below, hn::Set(f, 0x1p100f)));
    if (HWY_LIKELY(hn::AllTrue(f, hn::And(hn::Eq(below, above), in_range)))) continue;
    for (std::uint32_t k = i; k < std::min(i + step, count); ++k)
      squared[k] = squaredDistanceAsFloat(voxel.point(view, begin + k), place);
  }
}

/// Of points [begin, begin + count); writes whole vectors.
HWY_INLINE void measure(const PointsView& view, const Point3& place, const Voxel& voxel, std::uint32_t begin,
                        std::uint32_t count, float* squared)
{
  const hn::CappedTag<double, kLanes> d;
  if (voxel.frame.lossless) {
    const float* const stored[] = {voxel.x() + begin, voxel.y() + begin, voxel.z() + begin};
    const auto coordinate = [&](std::size_t axis, std::uint32_t i) {
      const hn::Rebind<float, decltype(d)> f;
      return hn::Add(hn::PromoteTo(d, hn::LoadU(f, stored[axis] + i)), hn::Set(d, voxel.frame.origin[axis]));
    };
    return measureBy(coordinate, view, place, voxel, begin, count, squared);
  }
  constexpr std::uint32_t kSome = 16;
  double given[3][kSome] = {};
  for (std::uint32_t from = 0; from < count; from += kSome) {
    const std::uint32_t some = std::min(count - from, kSome);
    for (std::uint32_t i = 0; i < some; ++i) {
      const Point3 p = view.point(voxel.records()[begin + from + i]);
      for (std::size_t axis = 0; axis < 3; ++axis) given[axis][i] = p[axis];
    }
    measureBy([&](std::size_t axis, std::uint32_t i) { return hn::LoadU(d, given[axis] + i); }, view, place, voxel,
              begin + from, some, squared + from);
  }
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle
