// SPDX-License-Identifier: BSD-3-Clause
// The queue of pairs that a search goes through best first.

#if defined(PCL_BSH_TRAVERSAL_PAIR_QUEUE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAVERSAL_PAIR_QUEUE_INL_H_
#undef PCL_BSH_TRAVERSAL_PAIR_QUEUE_INL_H_
#else
#define PCL_BSH_TRAVERSAL_PAIR_QUEUE_INL_H_
#endif

#include <pcl_bsh/traversal/pair_walk-inl.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// Children of one node that wait, each with the same lane of the other cloud.
struct WaitingChildren {
  LanePair pair; ///< of any one of them
  bool of_a = false;
  std::uint8_t left = 0; ///< bit i: child i waits
  alignas(32) float keys[kLanes] = {};

  /// The one with the smallest key; of equal ones the last. @pre one is left
  std::uint32_t nearest() const { return static_cast<std::uint32_t>(std::bit_width(smallestLanes(keys, left))) - 1; }

  LanePair child(std::uint32_t lane) const
  {
    LanePair one = pair;
    (of_a ? one.a : one.b).lane = lane;
    one.key = keys[lane];
    return one;
  }
};

/// Memory that queues use one after another; a ScratchLease lends it.
struct QueueScratch {
  std::vector<std::uint64_t> heap;
  std::vector<WaitingChildren> waiting;
  std::size_t bytes() const noexcept
  {
    return heap.capacity() * sizeof(std::uint64_t) + waiting.capacity() * sizeof(WaitingChildren);
  }
};

/// The pair with the smallest key comes first; of equal keys, one of those that were put in last. Children that a step
/// has found stay together, because most of them never come first. The heap holds one number for each step, ordered by
/// the smallest key of its children.
class PairQueue {
public:
  /// @param floor keys below it count as equal, except among children that were put in together
  explicit PairQueue(float floor = -std::numeric_limits<float>::infinity()) : floor_(floor) { clear(); }

  bool isEmpty() const { return heap_.empty(); }

  /// The number of steps that have children left.
  std::size_t size() const { return heap_.size(); }

  /// The smallest key, or `floor` if that is greater; infinity where the queue is empty.
  float least() const { return heap_.empty() ? std::numeric_limits<float>::infinity() : keyOf(heap_.front()); }

  /// @param children at least one; their keys are not NaN
  void push(const WaitingChildren& children)
  {
    if (waiting_.size() > 2 * heap_.size() + kFew) forgetTaken();
    heap_.push_back(entryOf(children, waiting_.size()));
    waiting_.push_back(children);
    std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
  }

  /// @pre not empty
  LanePair pop()
  {
    WaitingChildren& first = waiting_[placeOf(heap_.front())];
    const std::uint32_t lane = first.nearest();
    const LanePair pair = first.child(lane);
    first.left = static_cast<std::uint8_t>(first.left & ~(1u << lane));
    if (first.left != 0) {
      replaceFirst(entryOf(first, placeOf(heap_.front())));
      return pair;
    }
    const std::uint64_t last = heap_.back();
    heap_.pop_back();
    if (!heap_.empty()) replaceFirst(last);
    return pair;
  }

  /// Moves all pairs to a stack; the first pair is its last element.
  void drainTo(std::vector<LanePair>& stack)
  {
    const std::size_t from = stack.size();
    while (!isEmpty()) stack.push_back(pop());
    std::reverse(stack.begin() + static_cast<std::ptrdiff_t>(from), stack.end());
    clear();
  }

  void clear()
  {
    heap_.clear();
    waiting_.clear();
  }

private:
  static constexpr std::size_t kFew = 2048; ///< entries without children that may stay

  std::uint64_t entryOf(const WaitingChildren& children, std::size_t place) const
  {
    const float key = std::max(children.keys[children.nearest()], floor_);
    std::uint32_t bits;
    std::memcpy(&bits, &key, sizeof bits);
    bits ^= (bits >> 31) != 0 ? 0xffffffffu : 0x80000000u;
    return std::uint64_t{bits} << 32 | ~static_cast<std::uint32_t>(place);
  }

  static float keyOf(std::uint64_t entry)
  {
    auto bits = static_cast<std::uint32_t>(entry >> 32);
    bits ^= (bits >> 31) != 0 ? 0x80000000u : 0xffffffffu;
    float key;
    std::memcpy(&key, &bits, sizeof key);
    return key;
  }

  static std::uint32_t placeOf(std::uint64_t entry) { return ~static_cast<std::uint32_t>(entry); }

  /// Replaces the first entry by one that may come later, and restores the heap.
  void replaceFirst(std::uint64_t entry)
  {
    std::size_t at = 0;
    for (std::size_t next = 1; next < heap_.size(); next = 2 * at + 1) {
      if (next + 1 < heap_.size()) next += heap_[next + 1] < heap_[next] ? 1 : 0;
      if (entry < heap_[next]) break;
      heap_[at] = heap_[next];
      at = next;
    }
    heap_[at] = entry;
  }

  /// Removes entries without children from `waiting_`; the others keep their order.
  void forgetTaken()
  {
    std::sort(heap_.begin(), heap_.end(), [](std::uint64_t x, std::uint64_t y) { return placeOf(x) < placeOf(y); });
    for (std::uint32_t i = 0; i < heap_.size(); ++i) {
      waiting_[i] = waiting_[placeOf(heap_[i])];
      heap_[i] = (heap_[i] >> 32 << 32) | ~i;
    }
    waiting_.resize(heap_.size());
    std::make_heap(heap_.begin(), heap_.end(), std::greater<>());
  }

  const float floor_;
  const ScratchLease<QueueScratch> scratch_;
  std::vector<std::uint64_t>& heap_ = (*scratch_).heap;
  std::vector<WaitingChildren>& waiting_ = (*scratch_).waiting; ///< some have no children left
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
