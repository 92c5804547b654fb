// SPDX-License-Identifier: BSD-3-Clause
// Any pair, by several threads.
#include <pcl_bsh/pairs/shared_search.h>

#include <atomic>
#include <optional>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/pairs/any_collision_shared.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/pairs/any_search-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {
namespace {

/// Stops the search after some steps, or when what it looks for is of no use any more.
class Paused : public NoObserver {
public:
  struct Limit {
    std::uint32_t steps = kStepsAlone;
    const std::atomic<bool>* dropped = nullptr;
  };

  explicit Paused(Limit& limit) : limit_(limit) {}

  bool stops(const PairWalk&, const LanePair&, Opened)
  {
    if (limit_.steps == 0 || (limit_.dropped && limit_.dropped->load(std::memory_order_relaxed))) return true;
    --limit_.steps;
    return false;
  }

private:
  Limit& limit_;
};

/// What one of several threads does.
class AnyShare {
public:
  AnyShare(const Placed& a, const Placed& b, const AnyRequest& request, Places places)
  : search_(a, b, request, Paused(limit_), places)
  {
  }

  void operator()(SharedStack<LanePair>::Piece& piece)
  {
    limit_ = {kStepsOfPiece, &piece.dropped};
    search_.visit(piece);
  }

private:
  Paused::Limit limit_;
  AnySearch<Paused> search_;
};

} // namespace

AnyResult anyCollisionSharedOnTarget(const Placed& a, const Placed& b, const AnyRequest& request, Places places,
                                     unsigned threads)
{
  std::optional<SharedStack<LanePair>> shared;
  Work alone;
  {
    Paused::Limit limit;
    AnySearch search(a, b, request, Paused(limit), places);
    const AnyResult result = search.run();
    if (result.verdict != Verdict::undecided) return result;
    alone = result.work;
    shared.emplace(search.left());
  } // what it used is there for this thread's share
  shared->visit(threads, [&] { return AnyShare(a, b, request, places); });
  return resultOf({reachBetween(a, b, request.clearance, places), request.accuracy}, shared->found(), false,
                  alone += shared->work());
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(anyCollisionSharedOnTarget);

AnyResult anyCollisionShared(const Placed& a, const Placed& b, const AnyRequest& request, Places places,
                             unsigned threads)
{
  return HWY_DYNAMIC_DISPATCH(anyCollisionSharedOnTarget)(a, b, request, places, threads);
}

} // namespace pcl_bsh
#endif
