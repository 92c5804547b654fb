// SPDX-License-Identifier: BSD-3-Clause
// Results nearest first: ranks for a few, a vectorised quicksort for many.
#include <pcl_bsh/query/neighbor_scratch.h>

#include <hwy/contrib/sort/vqsort.h>

#include <bit>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/query/neighbor_sort.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/simd/rank_sort-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

void sortFewOnTarget(NeighborScratch& scratch)
{
  const std::size_t count = scratch.records.size();
  scratch.squared.room(kLanes);
  scratch.sorted_squared.clear();
  scratch.sorted_records.clear();
  scratch.sorted_squared.room(count);
  scratch.sorted_records.room(count);
  rankSort(scratch.squared.data(), scratch.records.data(), count, scratch.sorted_squared.data(),
           scratch.sorted_records.data());
  scratch.sorted_squared.resize(count);
  scratch.sorted_records.resize(count);
  std::swap(scratch.squared, scratch.sorted_squared);
  std::swap(scratch.records, scratch.sorted_records);
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(sortFewOnTarget);

void sortBySquared(NeighborScratch& scratch)
{
  constexpr std::size_t kFew = 96; // from about here on, the quadratic sort is the slower one
  const std::size_t count = scratch.records.size();
  if (count <= 1) return;
  if (count <= kFew) return HWY_DYNAMIC_DISPATCH(sortFewOnTarget)(scratch);

  // A squared distance and its record as one number: floats >= 0 are in the order of their bits.
  scratch.keys.clear();
  scratch.keys.room(count);
  for (std::size_t i = 0; i < count; ++i)
    scratch.keys[i] = std::uint64_t{std::bit_cast<std::uint32_t>(scratch.squared[i])} << 32 | scratch.records[i];
  thread_local const hwy::Sorter sorter;
  sorter(scratch.keys.data(), count, hwy::SortAscending());
  for (std::size_t i = 0; i < count; ++i) {
    scratch.squared[i] = std::bit_cast<float>(static_cast<std::uint32_t>(scratch.keys[i] >> 32));
    scratch.records[i] = static_cast<std::uint32_t>(scratch.keys[i]);
  }
}

} // namespace pcl_bsh
#endif
