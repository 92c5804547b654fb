// SPDX-License-Identifier: BSD-3-Clause
// Few numbers sorted without a branch: each one's place is how many come before it.

#if defined(PCL_BSH_SIMD_RANK_SORT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_SIMD_RANK_SORT_INL_H_
#undef PCL_BSH_SIMD_RANK_SORT_INL_H_
#else
#define PCL_BSH_SIMD_RANK_SORT_INL_H_
#endif

#include <pcl_bsh/simd/sphere_lanes-inl.h>

#include <bit>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Writes the values in ascending order, equal ones in the order given, and the records that go with them. Quadratic.
/// @param values none NaN; kLanes more must fit behind the last one, and are overwritten.
HWY_INLINE void rankSort(float* values, const std::uint32_t* records, std::size_t count, float* sorted_values,
                         std::uint32_t* sorted_records)
{
  const LaneTag d;
  const std::size_t step = hn::Lanes(d);
  for (std::size_t i = 0; i < step; ++i) values[count + i] = std::numeric_limits<float>::infinity();
  const auto countOf = [d](auto mask) { return static_cast<std::size_t>(std::popcount(bitsOf(d, mask))); };
  for (std::size_t i = 0; i < count; ++i) {
    const LaneVector value = hn::Set(d, values[i]);
    const std::size_t own = i - i % step;
    std::size_t rank = 0, j = 0;
    for (; j < own; j += step) rank += countOf(hn::Le(hn::LoadU(d, values + j), value));
    const LaneVector beside = hn::LoadU(d, values + own);
    rank += countOf(hn::Or(hn::Lt(beside, value), hn::And(hn::Eq(beside, value), hn::FirstN(d, i - own))));
    for (j += step; j < count; j += step) rank += countOf(hn::Lt(hn::LoadU(d, values + j), value));
    sorted_values[rank] = values[i];
    sorted_records[rank] = records[i];
  }
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
