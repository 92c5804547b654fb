// SPDX-License-Identifier: BSD-3-Clause
// Pairs that wait for a search that goes best first.

#if defined(PCL_BSH_TRAVERSAL_PAIR_QUEUE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAVERSAL_PAIR_QUEUE_INL_H_
#undef PCL_BSH_TRAVERSAL_PAIR_QUEUE_INL_H_
#else
#define PCL_BSH_TRAVERSAL_PAIR_QUEUE_INL_H_
#endif

#include <pcl_bsh/traversal/pair_walk-inl.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

/// Memory of one queue after another, to be had by a ScratchLease.
struct QueueScratch {
  std::vector<std::uint64_t> heap;
  std::vector<LanePair> pairs;
  std::size_t bytes() const noexcept
  {
    return heap.capacity() * sizeof(std::uint64_t) + pairs.capacity() * sizeof(LanePair);
  }
};

/// The pair with the smallest key comes first; of equal keys, the last that was put in. Pairs stay where they were put,
/// and the heap is of numbers that order as the keys do: moving these is a fraction of moving pairs.
class PairQueue {
public:
  PairQueue() { clear(); }

  bool isEmpty() const { return heap_.empty(); }
  std::size_t size() const { return heap_.size(); }

  /// The smallest key; infinity where there is none.
  float least() const { return heap_.empty() ? std::numeric_limits<float>::infinity() : pairOf(heap_.front()).key; }

  /// @param pair its key is not NaN
  void push(const LanePair& pair)
  {
    std::uint32_t bits;
    std::memcpy(&bits, &pair.key, sizeof bits);
    bits ^= (bits >> 31) != 0 ? 0xffffffffu : 0x80000000u;
    if (pairs_.size() > 2 * heap_.size() + kFew) forgetTaken();
    heap_.push_back(std::uint64_t{bits} << 32 | ~static_cast<std::uint32_t>(pairs_.size()));
    pairs_.push_back(pair);
    std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
  }

  /// @pre not empty
  LanePair pop()
  {
    std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
    const LanePair pair = pairOf(heap_.back());
    heap_.pop_back();
    return pair;
  }

  /// Moves all to a stack, so that what comes first is the last there.
  void drainTo(std::vector<LanePair>& stack)
  {
    std::sort(heap_.begin(), heap_.end(), std::greater<>());
    for (const std::uint64_t entry : heap_) stack.push_back(pairOf(entry));
    clear();
  }

  void clear()
  {
    heap_.clear();
    pairs_.clear();
  }

private:
  static constexpr std::size_t kFew = 4096; ///< pairs that may be left behind

  /// Leaves those in the queue alone, in their order.
  void forgetTaken()
  {
    const auto placeOf = [](std::uint64_t entry) { return ~static_cast<std::uint32_t>(entry); };
    std::sort(heap_.begin(), heap_.end(),
              [placeOf](std::uint64_t x, std::uint64_t y) { return placeOf(x) < placeOf(y); });
    for (std::uint32_t i = 0; i < heap_.size(); ++i) {
      pairs_[i] = pairOf(heap_[i]);
      heap_[i] = (heap_[i] >> 32 << 32) | ~i;
    }
    pairs_.resize(heap_.size());
    std::make_heap(heap_.begin(), heap_.end(), std::greater<>());
  }

  const LanePair& pairOf(std::uint64_t entry) const { return pairs_[~static_cast<std::uint32_t>(entry)]; }

  const ScratchLease<QueueScratch> scratch_;
  std::vector<std::uint64_t>& heap_ = (*scratch_).heap;
  std::vector<LanePair>& pairs_ = (*scratch_).pairs; ///< those, and some that were taken
};

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle
