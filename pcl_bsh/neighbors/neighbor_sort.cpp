// SPDX-License-Identifier: BSD-3-Clause
// Results nearest first: ranks for a few; for many, steps of distance, or a vectorised quicksort.
#include <pcl_bsh/neighbors/neighbor_scratch.h>

#include <algorithm>
#include <bit>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/neighbors/neighbor_sort.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/simd/rank_sort-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

void sortFewOnTarget(NeighborScratch& scratch)
{
  const std::size_t count = scratch.records.size();
  scratch.squared.reserveMore(kLanes);
  scratch.sorted_squared.clear();
  scratch.sorted_records.clear();
  scratch.sorted_squared.reserveMore(count);
  scratch.sorted_records.reserveMore(count);
  rankSort(scratch.squared.data(), scratch.records.data(), count, scratch.sorted_squared.data(),
           scratch.sorted_records.data());
  scratch.sorted_squared.resize(count);
  scratch.sorted_records.resize(count);
  std::swap(scratch.squared, scratch.sorted_squared);
  std::swap(scratch.records, scratch.sorted_records);
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(sortFewOnTarget);

namespace {

/// Sorts by counting in equal steps of squared distance, of which each has few points of a surface. Scatters the keys
/// by step, and moves the few that are left out of order. @return false, and nothing done, where the steps are too
/// full.
bool sortBySteps(NeighborScratch& scratch, std::size_t count)
{
  constexpr std::uint32_t kFull = 12; // keys of one step, beyond which moving them one by one takes too long
  const float* const squared = scratch.squared.data();
  float largest = 0.0f;
  for (std::size_t i = 0; i < count; ++i) largest = std::max(largest, squared[i]);
  const std::size_t steps = std::bit_ceil(count);
  const float scale = static_cast<float>(steps - 1) / largest; // not a number, or infinite, where that is of no use
  if (!(scale * largest < static_cast<float>(steps)) || count > std::size_t{1} << 20) return false;

  scratch.steps.clear();
  scratch.steps.reserveMore(count + steps + 1);
  std::uint32_t* const step = scratch.steps.data();
  std::uint32_t* const starts = step + count; // of the step before, while counting
  std::fill_n(starts, steps + 1, 0u);
  for (std::size_t i = 0; i < count; ++i) step[i] = static_cast<std::uint32_t>(squared[i] * scale);
  for (std::size_t i = 0; i < count; ++i) ++starts[step[i] + 1];
  std::uint32_t fullest = 0;
  for (std::size_t k = 1; k <= steps; ++k) {
    fullest = std::max(fullest, starts[k]);
    starts[k] += starts[k - 1];
  }
  if (fullest > kFull) return false;

  scratch.sorted_keys.clear();
  scratch.sorted_keys.reserveMore(count);
  std::uint64_t* const keys = scratch.sorted_keys.data();
  for (std::size_t i = 0; i < count; ++i) keys[starts[step[i]]++] = scratch.keys[i];
  for (std::size_t i = 1; i < count; ++i) {
    const std::uint64_t key = keys[i];
    std::size_t k = i;
    for (; k > 0 && keys[k - 1] > key; --k) keys[k] = keys[k - 1];
    keys[k] = key;
  }
  std::swap(scratch.keys, scratch.sorted_keys);
  return true;
}

} // namespace

void sortBySquared(NeighborScratch& scratch)
{
  constexpr std::size_t kFew = 64; // from about here on, the quadratic sort is the slower one
  const std::size_t count = scratch.records.size();
  if (count <= 1) return;
  if (count <= kFew) return HWY_DYNAMIC_DISPATCH(sortFewOnTarget)(scratch);

  // A squared distance and its record as one number: floats >= 0 are in the order of their bits.
  scratch.keys.clear();
  scratch.keys.reserveMore(count);
  for (std::size_t i = 0; i < count; ++i)
    scratch.keys[i] = std::uint64_t{std::bit_cast<std::uint32_t>(scratch.squared[i])} << 32 | scratch.records[i];
  if (!sortBySteps(scratch, count)) {
    scratch.sorter(scratch.keys.data(), count, hwy::SortAscending());
  }
  for (std::size_t i = 0; i < count; ++i) {
    scratch.squared[i] = std::bit_cast<float>(static_cast<std::uint32_t>(scratch.keys[i] >> 32));
    scratch.records[i] = static_cast<std::uint32_t>(scratch.keys[i]);
  }
}

} // namespace pcl_bsh
#endif
