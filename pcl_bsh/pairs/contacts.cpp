// SPDX-License-Identifier: BSD-3-Clause
// Contacts: depth first as any and closest pair, keeping the nearest pairs in a heap once there are enough of them.
#include <pcl_bsh/pairs/check_request.h>
#include <pcl_bsh/pairs/contacts.h>
#include <pcl_bsh/query/progress.h>

#include <algorithm>
#include <cmath>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/pairs/contacts.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/traversal/visit_pairs-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {
namespace {

/// What a sink did with a pair.
enum class Added { kept, dropped, stop };

/// Walks to every pair of points within a reach and hands it to a sink: `double reach()`, how far pairs are still of
/// interest, which may shrink, to less than 0 where points have radii; `Added add(PointPair, Work&)`.
template <class Sink>
class ReachWalk : public PairVisitor {
public:
  ReachWalk(const Placed& a, const Placed& b, double clearance, Sink& sink, Progress& progress)
  : PairVisitor(Watch{&progress, 1.0}),
    walk_(a, b),
    pairs_(a, b, clearance),
    sink_(sink)
  {
  }

  Work run()
  {
    stack_.clear();
    walk_.seed(reach(), [this](LanePair pair, const PairWalk::Step& step, std::uint32_t lane) {
      keep(pair, Opened::b, step, lane);
      stack_.push_back(pair);
    });
    nearestLast(stack_, 0);
    visitPairs(walk_, stack_, *this);
    return walk_.work;
  }

  // As visitPairs() asks.

  /// What spheres are tested with.
  double reach() const { return std::max(sink_.reach(), 0.0); }

  Next visit(const LanePair& pair) const { return pair.key > sink_.reach() ? Next::prune : Next::go_on; }

  bool keep(LanePair& pair, Opened, const PairWalk::Step& step, std::uint32_t lane) const
  {
    pair.key = walk_.boundKey(pair, step, lane);
    return true;
  }

  Next compare(const LanePair& pair)
  {
    const ComparedLeaves leaves = walk_.compare(pair, reach());
    if (leaves.near == 0) return Next::go_on;
    const LeafRange &a = leaves.a, &b = leaves.b;
    // Points of one place share a leaf, and the first of them was compared for all.
    const std::uint32_t places_a = coincident(walk_.a, pair.a), places_b = coincident(walk_.b, pair.b);
    bool going = true;
    const auto found = [&](std::uint32_t i, std::uint32_t j, bool surely) {
      if (surely || pairs_.collide({a.record(i), b.record(j)}, walk_.work))
        going = addAll({a.voxel, a.begin + i, places_a}, {b.voxel, b.begin + j, places_b});
      return !going;
    };
    if (pairs_.haveRadii()) {
      eachBallPairNear(leaves.frame, leaves.points, leaves.near, a, b, sink_.reach(), pairs_.surelyOfBalls(),
                       [&](std::uint32_t i, std::uint32_t j, float, bool surely) { return found(i, j, surely); });
    }
    else {
      const float hit = leaves.frame.band(pairs_.reach.length()).hit;
      double reach = sink_.reach();
      float miss = leaves.frame.band(reach).miss;
      eachPairNotBeyond(leaves.points, leaves.near, b, miss, [&](std::uint32_t i, std::uint32_t j, float squared) {
        if (sink_.reach() < reach) { // shrunk since the last pair that was near
          reach = sink_.reach();
          miss = leaves.frame.band(reach).miss;
        }
        return !(squared > miss) && found(i, j, squared <= hit);
      });
    }
    return going ? Next::go_on : Next::stop;
  }

private:
  /// How many points stand where the leaf's compared ones do: more than one only where a single one is compared.
  std::uint32_t coincident(const Spaces& side, const Lane& lane) const
  {
    const Node& node = walk_.nodeOf(side, lane);
    return node.isCoincident(lane.lane) ? node.points(lane.lane) : 1;
  }

  /// All pairs of two ranges of points, each of one place and one radius; records ascend where a range has several.
  bool addAll(const LeafRange& a, const LeafRange& b)
  {
    for (std::uint32_t i = 0; i < a.count; ++i)
      for (std::uint32_t j = 0; j < b.count; ++j) {
        pulse_.count(1);
        const Added added = sink_.add({a.record(i), b.record(j)}, walk_.work);
        if (added == Added::stop) return false;
        if (added != Added::kept) return true; // of pairs at one distance, those that follow are larger still
      }
    return true;
  }

  PairWalk walk_;
  PointPairs pairs_;
  Sink& sink_;
  Pulse pulse_; ///< of pairs at one place
  const ScratchLease<PairStack> kept_stack_;
  std::vector<LanePair>& stack_ = (*kept_stack_).pairs;
};

/// All of them, until there are too many.
class AllPairs {
public:
  AllPairs(double clearance, std::size_t most, PairsWithin& result)
  : clearance_(clearance),
    most_(most),
    result_(result)
  {
  }

  double reach() const { return clearance_; }

  Added add(PointPair pair, Work&)
  {
    result_.complete = result_.pairs.size() < most_;
    if (!result_.complete) return Added::stop;
    result_.pairs.push_back(pair);
    return Added::kept;
  }

private:
  double clearance_;
  std::size_t most_;
  PairsWithin& result_;
};

struct PairGap {
  double gap; ///< rounded
  PointPair pair;
};

/// Memory of one NearestPairs after another, to be had by a ScratchLease.
struct PairHeap {
  std::vector<PairGap> pairs;
  std::size_t bytes() const noexcept { return pairs.capacity() * sizeof(PairGap); }
};

/// The nearest pairs: once full, a heap whose first pair is the farthest of them.
class NearestPairs {
  /// Rounding keeps the order of gaps, but may make some equal that are not.
  bool before(const PairGap& l, const PairGap& r) const
  {
    if (l.gap != r.gap) return l.gap < r.gap;
    pulse_.count(128); // exact decisions are slow where they are ties
    const int sign = pairs_.distance.compareGaps(pairs_.posed(l.pair), pairs_.posed(r.pair));
    return sign != 0 ? sign < 0 : l.pair < r.pair;
  }
  auto order() const
  {
    return [this](const PairGap& l, const PairGap& r) { return before(l, r); };
  }

public:
  NearestPairs(const Placed& a, const Placed& b, double clearance, std::size_t most)
  : pairs_(a, b, clearance),
    most_(std::min(most, std::numeric_limits<std::size_t>::max() - 1) +
          1), // one more pair shows that some are left out
    reach_(clearance)
  {
    kept_.clear();
  }

  double reach() const { return reach_; }

  Added add(PointPair pair, Work& work)
  {
    ++work.exact_decisions;
    const PairGap entry{pairs_.distance.gap(pairs_.posed(pair)), pair};
    if (kept_.size() == most_) {
      if (!before(entry, kept_.front())) return Added::dropped;
      std::pop_heap(kept_.begin(), kept_.end(), order());
      kept_.pop_back();
    }
    kept_.push_back(entry);
    if (kept_.size() == most_) {
      heaped_ ? std::push_heap(kept_.begin(), kept_.end(), order())
              : std::make_heap(kept_.begin(), kept_.end(), order());
      heaped_ = true;
      reach_ = std::min(reach_, std::nextafter(kept_.front().gap, std::numeric_limits<double>::infinity()));
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
      const Point3 p = a.hierarchy().view().point(entry.pair.a), q = b.hierarchy().view().point(entry.pair.b);
      const Eigen::Vector3d apart = pairs_.ofTriangles() ? pairs_.distance.between(entry.pair)
                                                         : a.pose * Eigen::Vector3d(p[0], p[1], p[2]) -
                                                               b.pose * Eigen::Vector3d(q[0], q[1], q[2]);
      result.contacts.push_back({entry.pair, entry.gap, apart.stableNormalized()});
    }
  }

private:
  PointPairs pairs_;
  std::size_t most_;
  double reach_;
  bool heaped_ = false;
  mutable Pulse pulse_; ///< of ties
  const ScratchLease<PairHeap> scratch_;
  std::vector<PairGap>& kept_ = (*scratch_).pairs;
};

} // namespace

void nearestContactsOnTarget(const Placed& a, const Placed& b, const ContactsRequest& request, Progress& progress,
                             ContactsResult& result)
{
  NearestPairs sink(a, b, request.clearance, request.most);
  result.work = ReachWalk(a, b, request.clearance, sink, progress).run();
  sink.collect(a, b, result);
}

void pairsWithinOnTarget(const Placed& a, const Placed& b, const ContactsRequest& request, Progress& progress,
                         PairsWithin& result)
{
  AllPairs sink(request.clearance, request.most, result);
  result.work = ReachWalk(a, b, request.clearance, sink, progress).run();
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
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
