// SPDX-License-Identifier: BSD-3-Clause
// Contacts: depth first as any and closest pair, keeping the nearest pairs in a heap once there are enough of them.
#include <pcl_bsh/pairs/check_request.h>
#include <pcl_bsh/pairs/contacts.h>
#include <pcl_bsh/pairs/nearest_places.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/traversal/planes_between.h>

#include <algorithm>
#include <cmath>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/pairs/contacts.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/pairs/reach_walk-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {
namespace {

/// Keeps all pairs within the clearance, until there are too many.
class AllPairs {
public:
  static constexpr bool kHasWays = false;

  AllPairs(const Placed& a, const Placed& b, const ContactsRequest& request, PairsWithin& result)
  : pairs(a, b, request.clearance),
    clearance_(request.clearance),
    most_(request.most),
    result_(result)
  {
  }

  double reach() const { return clearance_; }

  static bool passesOver(const PairWalk&, const LanePair&) { return false; }

  Added add(PointPair pair, bool surely, Work& work)
  {
    if (!surely && !pairs.collide(pair, work)) return Added::dropped;
    return keepPair(pair, most_, result_);
  }

  const PointPairs pairs;

private:
  const double clearance_;
  const std::size_t most_;
  PairsWithin& result_;
};

/// A pair, and its gap: rounded, or of triangles between two bounds.
struct PairGap {
  static constexpr std::uint32_t kAlone = 0xffffffffu;

  double low, high;
  PointPair pair;
  mutable std::uint32_t tie = kAlone; ///< number of a set of pairs that are exactly as near
};

/// Memory that NearestPairs use one after another; a ScratchLease lends it.
struct PairHeap {
  std::vector<PairGap> pairs;
  std::size_t bytes() const noexcept { return pairs.capacity() * sizeof(PairGap); }
};

/// The nearest pairs: once full, a heap whose first pair is the farthest of them.
class NearestPairs {
  /// Rounding keeps the order of gaps, but may make some equal that are not.
  bool before(const PairGap& l, const PairGap& r) const
  {
    if (l.high < r.low) return true;
    if (r.high < l.low) return false;
    if (areTied(l, r)) return l.pair < r.pair;
    pulse_.count(128); // exact decisions are slow where they are ties
    ++orders_;
    const int sign = pairs.distance.compareGaps(pairs.posed(l.pair), pairs.posed(r.pair));
    if (sign != 0) return sign < 0;
    tie(l, r);
    return l.pair < r.pair;
  }

  /// Whether both gaps are known to be equal.
  bool areTied(const PairGap& l, const PairGap& r) const
  {
    if (pairs.ofTriangles() && l.high == 0.0 && r.high == 0.0 && !pairs.mayOverlap()) return true;
    return l.tie != PairGap::kAlone && r.tie != PairGap::kAlone && firstTie(l.tie) == firstTie(r.tie);
  }

  void tie(const PairGap& l, const PairGap& r) const
  {
    if (!pairs.ofTriangles()) return; // points are compared as quickly
    if (l.tie == PairGap::kAlone && r.tie == PairGap::kAlone) {
      l.tie = static_cast<std::uint32_t>(ties_.size());
      ties_.push_back(l.tie);
    }
    if (l.tie == PairGap::kAlone) l.tie = r.tie;
    if (r.tie == PairGap::kAlone) r.tie = l.tie;
    ties_[firstTie(l.tie)] = firstTie(r.tie);
  }

  std::uint32_t firstTie(std::uint32_t tie) const
  {
    while (ties_[tie] != tie) tie = ties_[tie] = ties_[ties_[tie]];
    return tie;
  }

  auto order() const
  {
    return [this](const PairGap& l, const PairGap& r) { return before(l, r); };
  }

public:
  static constexpr bool kHasWays = false;

  NearestPairs(const Placed& a, const Placed& b, const ContactsRequest& request)
  : pairs(a, b, request.clearance),
    clearance_(request.clearance),
    most_(std::min(request.most, std::numeric_limits<std::size_t>::max() - 1) +
          1), // one more pair shows that some are left out
    reach_(request.clearance),
    planes_(pairs.distance, a.hierarchy().storage(), b.hierarchy().storage(), kDecisionsBeforePlanes)
  {
    kept_.clear();
  }

  double reach() const { return reach_; }

  /// Whether nothing below two lanes is nearer than the farthest pair kept, nor as near with smaller records. Known
  /// where that pair meets, or by planes between its nearest places.
  bool passesOver(const PairWalk& walk, const LanePair& lanes)
  {
    none_nearer_ = false;
    return HWY_UNLIKELY(planes_.areLaid() || meet_) && isSettled(walk, lanes);
  }

  Added add(PointPair pair, bool surely, Work& work)
  {
    const bool is_full = kept_.size() == most_;
    if (none_nearer_ && is_full && kept_.front().pair < pair) return Added::dropped;
    const RecordDistance::Pair posed = pairs.posed(pair);
    PairGap entry{0.0, 0.0, pair};
    if (pairs.ofTriangles()) {
      if (pairs.distance.isSurelyBeyond(posed, reach_)) return Added::dropped;
      if (planes_.areLaid() && kept_.front().pair < pair && areBehind(pair)) return Added::dropped;
      boundGap(posed, entry);
      surely = surely || entry.high <= clearance_;
    }
    if (!surely && !pairs.collide(pair, work)) return Added::dropped;
    ++work.exact_decisions;
    if (!pairs.ofTriangles()) entry.low = entry.high = pairs.distance.gap(posed);
    if (is_full) {
      const std::uint64_t orders = orders_;
      if (!before(entry, kept_.front())) {
        if (orders_ != orders) decidedInVain();
        return Added::dropped;
      }
      std::pop_heap(kept_.begin(), kept_.end(), order());
      kept_.pop_back();
    }
    kept_.push_back(entry);
    if (kept_.size() == most_) {
      heaped_ ? std::push_heap(kept_.begin(), kept_.end(), order())
              : std::make_heap(kept_.begin(), kept_.end(), order());
      heaped_ = true;
      const double farthest = kept_.front().high;
      reach_ = std::min(reach_, std::nextafter(farthest, std::numeric_limits<double>::infinity()));
      meet_ = pairs.ofTriangles() && farthest == 0.0 && !pairs.mayOverlap();
    }
    return Added::kept;
  }

  /// @param result without contacts
  void collect(const Placed& a, const Placed& b, ContactsResult& result)
  {
    std::sort(kept_.begin(), kept_.end(), order());
    result.complete = kept_.size() < most_;
    if (!result.complete) kept_.pop_back();
    result.contacts.reserve(kept_.size());
    for (const PairGap& entry : kept_) {
      auto [at_a, at_b] = nearestPlaces(a, b, entry.pair);
      const Eigen::Vector3d apart = pairs.ofTriangles() ? pairs.distance.between(entry.pair) : at_a - at_b;
      const double gap = pairs.ofTriangles() ? pairs.gap(entry.pair) : entry.high;
      const double size = apart.lpNorm<Eigen::Infinity>(); // Eigen's stableNormalized() rounds at the least numbers
      const Eigen::Vector3d normal = size > 0.0 ? (apart / size).normalized() : Eigen::Vector3d::Zero().eval();
      at_a -= a.hierarchy().view().ownRadius(entry.pair.a) * normal;
      at_b += b.hierarchy().view().ownRadius(entry.pair.b) * normal;
      result.contacts.push_back({entry.pair, gap, normal, at_a, at_b});
    }
  }

  const PointPairs pairs;

private:
  static constexpr std::uint64_t kDecisionsBeforePlanes = 8;
  static constexpr std::uint64_t kLooksForDecision = 256; ///< looks at records in vain, for each decision
  static constexpr std::uint64_t kMostLooked = 512;       ///< below a lane: larger nodes would be looked at often

  /// Sets the bounds of a gap that doubles tell; rounding the gap takes ten times as long.
  void boundGap(const RecordDistance::Pair& posed, PairGap& entry) const
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const auto [low, high] = pairs.distance.enclose(posed);
    const double radii = posed.radius_p + posed.radius_q, rounding = kFewDoubleRoundings * (high + radii);
    entry.low = low - radii - rounding;
    entry.high = high - radii + rounding;
    if (!(entry.high < infinity)) {
      const double gap = pairs.distance.gap(posed);
      entry.low = std::nextafter(gap, -infinity), entry.high = std::nextafter(gap, infinity);
    }
    if (entry.low <= 0.0 && !pairs.mayOverlap() && pairs.distance.compare(posed, 0.0) == 0)
      entry.low = entry.high = 0.0;
  }

  /// Whether a pair is no nearer than the one that planes were laid for.
  bool areBehind(PointPair pair)
  {
    if (!planes_.areBehind(pair)) return false;
    looks_ += kLooksForDecision;
    return true;
  }

  /// Counts a pair that doubles did not tell from the farthest one. Enough of them pay for planes.
  void decidedInVain()
  {
    looks_ += kLooksForDecision;
    planes_.policy.decidedInVain();
    if (!planes_.policy.mayAsk() || !pairs.ofTriangles()) return;
    const std::uint64_t in_vain = planes_.policy.decisionsInVain();
    planes_.policy.wait(in_vain + in_vain / 8 + kDecisionsBeforePlanes);
    const PointPair farthest = kept_.front().pair;
    if (planes_of_ == farthest) return;
    planes_of_ = farthest;
    planes_.lay(farthest);
  }

  HWY_NOINLINE bool isSettled(const PairWalk& walk, const LanePair& lanes)
  {
    PointPair first = walk.lowest(lanes);
    none_nearer_ = meet_;
    if (!meet_) {
      const std::uint64_t allowed = std::min(kMostLooked, looks_);
      std::uint64_t left = allowed;
      const auto touching = planes_.touching(walk.child(walk.a, lanes.a), walk.child(walk.b, lanes.b), left);
      none_nearer_ = touching.has_value();
      if (!none_nearer_) {
        looks_ -= allowed - left;
        return false;
      }
      first = {touching->a.lowest, touching->b.lowest};
    }
    return kept_.front().pair < first;
  }

  const double clearance_;
  const std::size_t most_;
  double reach_;
  bool heaped_ = false;
  bool meet_ = false;    ///< whether all pairs kept meet
  PlanesBetween planes_; ///< of a pair that was the farthest
  PointPair planes_of_;
  bool none_nearer_ = false; ///< below the lanes that are visited
  std::uint64_t looks_ = 0;
  mutable std::uint64_t orders_ = 0;        ///< comparisons that doubles did not decide
  mutable std::vector<std::uint32_t> ties_; ///< by PairGap::tie: the set that it was joined to, or itself
  mutable Pulse pulse_;                     ///< of ties
  const ScratchLease<PairHeap> scratch_;
  std::vector<PairGap>& kept_ = (*scratch_).pairs;
};

} // namespace

void nearestContactsOnTarget(const Placed& a, const Placed& b, const ContactsRequest& request, Progress& progress,
                             ContactsResult& result)
{
  NearestPairs receiver(a, b, request);
  result.work = ReachWalk(a, b, receiver, progress).run();
  receiver.collect(a, b, result);
}

void pairsWithinOnTarget(const Placed& a, const Placed& b, const ContactsRequest& request, Progress& progress,
                         PairsWithin& result)
{
  AllPairs receiver(a, b, request, result);
  result.work = ReachWalk(a, b, receiver, progress).run();
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(nearestContactsOnTarget);
HWY_EXPORT(pairsWithinOnTarget);

void nearestContacts(const Placed& a, const Placed& b, const ContactsRequest& request, ContactsResult& result)
{
  check(a, b, request);
  const DefaultFloatEnvironment environment;
  Progress progress(request.progress);
  result.contacts.clear();
  result.complete = false; // should something throw, the result does not claim that nothing collides
  HWY_DYNAMIC_DISPATCH(nearestContactsOnTarget)(a, b, request, progress, result);
  progress.finish();
}

ContactsResult nearestContacts(const Placed& a, const Placed& b, const ContactsRequest& request)
{
  ContactsResult result;
  nearestContacts(a, b, request, result);
  return result;
}

void pairsWithin(const Placed& a, const Placed& b, const ContactsRequest& request, PairsWithin& result)
{
  check(a, b, request);
  const DefaultFloatEnvironment environment;
  Progress progress(request.progress);
  result.pairs.clear();
  result.complete = false; // as above
  PairsWithin found;
  found.pairs.swap(result.pairs);
  HWY_DYNAMIC_DISPATCH(pairsWithinOnTarget)(a, b, request, progress, found);
  progress.finish();
  result = std::move(found);
}

PairsWithin pairsWithin(const Placed& a, const Placed& b, const ContactsRequest& request)
{
  PairsWithin result;
  pairsWithin(a, b, request, result);
  return result;
}

} // namespace pcl_bsh
#endif
