// SPDX-License-Identifier: BSD-3-Clause
// The closest pair, by one thread or by several.
#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/pairs/check_request.h>
#include <pcl_bsh/pairs/closest_goal.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/traversal/shared_stack.h>

#include <atomic>
#include <mutex>
#include <optional>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/pairs/closest_pair.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/pairs/closest_search-inl.h>

#ifndef PCL_BSH_PAIRS_CLOSEST_PAIR_ONCE
#define PCL_BSH_PAIRS_CLOSEST_PAIR_ONCE
namespace pcl_bsh {
namespace {

/// The nearest pair that any of several threads has found.
class SharedNearest {
public:
  /// Makes both the nearer one of the two; of equals, the smaller (a, b).
  void merge(Nearest& own, const PointPairs& pairs)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (nearest_.pair) {
      const int sign = pairs.distance.compareGaps(pairs.posed(*own.pair), pairs.posed(*nearest_.pair));
      if (sign > 0 || (sign == 0 && !(*own.pair < *nearest_.pair))) {
        own = nearest_;
        return;
      }
    }
    nearest_ = own;
    version_.fetch_add(1, std::memory_order_relaxed);
  }

  /// The next get() is at least as new as this version.
  std::uint64_t version() const { return version_.load(std::memory_order_relaxed); }

  Nearest get() const
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    return nearest_;
  }

private:
  mutable std::mutex mutex_;
  Nearest nearest_;
  std::atomic<std::uint64_t> version_{0};
};

/// One of several searches that share what they find, and pause after some steps.
class Sharing {
public:
  static constexpr bool kAreThere = true;

  explicit Sharing(SharedNearest& shared) : shared_(shared) {}

  void allow(const Pause& pause) { pause_ = pause; }
  bool stops() { return pause_.stops(); }

  void hear(Nearest& own)
  {
    const std::uint64_t version = shared_.version();
    if (version == heard_) return;
    heard_ = version;
    own = shared_.get();
  }

  void tell(Nearest& own, const PointPairs& pairs) { shared_.merge(own, pairs); }

private:
  SharedNearest& shared_;
  Pause pause_;
  std::uint64_t heard_ = 0;
};

} // namespace
} // namespace pcl_bsh
#endif

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

DistanceResult closestPairOnTarget(const Placed& a, const Placed& b, const ClosestGoal& goal, unsigned threads,
                                   Progress& progress)
{
  if (threads == 1) return ClosestSearch(a, b, goal, NoOthers(), {&progress, 1.0}).run();
  SharedNearest nearest;
  std::optional<SharedStack<LanePair>> shared;
  Work work;
  {
    ClosestSearch alone(a, b, goal, Sharing(nearest), {&progress, 1.0});
    const DistanceResult result = alone.run();
    if (alone.left().empty()) return result;
    work = result.work;
    shared.emplace(alone.left());
  } // its memory is free for this thread's share now
  shared->visit(threads, [&] { return ClosestSearch(a, b, goal, Sharing(nearest)); });
  return ClosestSearch(a, b, goal, Sharing(nearest)).result(work += shared->work());
}

AnyResult searchWithinOnTarget(const Placed& a, const Placed& b, const ClosestGoal& goal, const Watch& watch)
{
  ClosestSearch search(a, b, goal, NoOthers(), watch);
  return search.verdict(search.run());
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(closestPairOnTarget);
HWY_EXPORT(searchWithinOnTarget);

DistanceResult closestPair(const Placed& a, const Placed& b, const DistanceRequest& request)
{
  check(a, b, request);
  const ClosestGoal goal(request.accuracy, request.max_distance);
  const DefaultFloatEnvironment environment;
  Progress progress(request.progress);
  const unsigned threads = request.accuracy.isExact() ? threadCount(request.threads) : 1;
  DistanceResult found = HWY_DYNAMIC_DISPATCH(closestPairOnTarget)(a, b, goal, threads, progress);
  progress.finish();
  return found;
}

AnyResult searchWithin(const Placed& a, const Placed& b, const ClosestGoal& goal, const Watch& watch)
{
  return HWY_DYNAMIC_DISPATCH(searchWithinOnTarget)(a, b, goal, watch);
}

} // namespace pcl_bsh
#endif
