// SPDX-License-Identifier: BSD-3-Clause
// The search for the closest pair: best first among some hundred pairs, then depth first, nearest children first, until
// nothing left can be nearer.

#if defined(PCL_BSH_PAIRS_CLOSEST_SEARCH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_PAIRS_CLOSEST_SEARCH_INL_H_
#undef PCL_BSH_PAIRS_CLOSEST_SEARCH_INL_H_
#else
#define PCL_BSH_PAIRS_CLOSEST_SEARCH_INL_H_
#endif

#include <pcl_bsh/pairs/best_pair-inl.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/traversal/pair_queue-inl.h>
#include <pcl_bsh/traversal/shared_stack.h>
#include <pcl_bsh/traversal/visit_pairs-inl.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

namespace { // the search is inlined where it is its translation unit's own

/// No other thread searches. Its calls compile to nothing.
struct NoOthers {
  static constexpr bool kAreThere = false;
  static bool stops() { return false; }
  static void hear(Nearest&) {}
  static void tell(Nearest&, const PointPairs&) {}
};

} // namespace

/// Steps between two dives: from the best pair down to a pair of leaves, by the nearest children. Best first alone
/// finds near pairs late; each dive that finds none doubles the steps to the next one.
inline constexpr std::uint32_t kStepsBetweenDives = 12;

/// Pairs of leaves that a search with a time compares before it may take long steps. Most searches come to no more.
inline constexpr std::uint64_t kPairsBeforePoints = 48;

/// @tparam Others the searches of other threads: `kAreThere`; `stops()` before each pair is visited, whether to pause
///   there; `hear(nearest)`: sets it to what they have found; `tell(nearest, pairs)`: gives it to them, or sets it to
///   theirs where that is nearer; `allow(pause)`: sets when to stop
template <class Others>
class ClosestSearch : public PairVisitor, private BestPair {
public:
  ClosestSearch(const Placed& a, const Placed& b, const ClosestGoal& goal, Others others, const Watch& by = {})
  : PairVisitor(by),
    BestPair(a, b, goal),
    stop_check_(goal_.rule, walk_.work.node_pairs),
    others_(std::move(others))
  {
    if (goal_.rule.isTimed()) walk_.pairs_before_points = kPairsBeforePoints;
  }

  /// Searches until the end, until the accuracy's budget is spent or, where there are other threads, for some steps:
  /// pairs may be left().
  DistanceResult run()
  {
    stack_.clear();
    walk_.seedWhole(kInfinity, [this](LanePair pair, const PairWalk::Step& step) {
      walk_.boundKeys(pair, step, keys_);
      pair.key = keys_[0];
      if (goal_.rule.mayStop()) considerOneOf(pair); // so that there is a pair, however soon it stops
      if (canImprove(pair)) queue_.push({pair, false, 1, {pair.key}});
    });
    searchBestFirst();
    if (goal_.rule.mayStop()) return result(walk_.work);
    queue_.drainTo(stack_);
    if (!Others::kAreThere && !stack_.empty()) visitPairs(walk_, stack_, *this);
    return result(walk_.work);
  }

  /// Visits the pairs of a piece and what is below, until it is stopped.
  void operator()(SharedStack<LanePair>::Piece& piece)
  {
    others_.allow({kStepsOfPiece, &piece.dropped});
    stack_.assign(piece.pairs.begin(), piece.pairs.end());
    visitPairs(walk_, stack_, *this);
    piece.pairs.assign(stack_.begin(), stack_.end());
    piece.work = std::exchange(walk_.work, Work());
  }

  const std::vector<LanePair>& left() const { return stack_; }

  /// The result as far as it is known by now.
  DistanceResult result(const Work& work)
  {
    others_.hear(best_);
    if (!best_.pair) return {kInfinity, std::nullopt, {leastBeyond(), kInfinity}, work};
    const double gap = pairs_.gap(*best_.pair);
    return {gap, best_.pair, intervalOf(gap), work};
  }

  using BestPair::verdict;

  // As visitPairs() asks.

  static constexpr bool kBounds = true;

  /// Distances above this are of no interest. A dive looks for any nearer pair, even one that is nearer by less than
  /// the tolerance.
  double reach() const { return std::max(diving_ && best_.pair ? best_.high : best_.to_beat, 0.0); }

  /// Whether there is time for what opening a pair takes.
  bool opens(const LanePair& pair, Opened opened)
  {
    if (!goal_.rule.isTimed()) return true;
    const std::size_t points = walk_.pointsToPrepare(pair, opened);
    if (points == 0 || goal_.rule.leavesTimeToBuild(points)) return true;
    left_over_ = std::min(left_over_, pair.key);
    considerOneOf(pair);
    return false;
  }

  Next visit(const LanePair& pair)
  {
    others_.hear(best_);
    if (!mayImprove(pair)) return Next::prune;
    return others_.stops() ? Next::stop : Next::go_on;
  }

  Next opened(const LanePair& pair, Opened opened, const PairWalk::Step& step)
  {
    if (step.near == 0) return Next::go_on;
    walk_.boundKeys(PairWalk::childOf(pair, opened, step, 0), step, keys_);
    std::uint32_t low = raiseLanes(keys_, pair.key, lowest_key_) & step.near;
    if (HWY_UNLIKELY(low != 0) && !pairs_.mayOverlap()) {
      for (const std::uint32_t lane : Bits(low)) keys_[lane] = overlapOf(step, lane);
    }
    return Next::go_on;
  }

  bool keep(LanePair& pair, Opened, const PairWalk::Step&, std::uint32_t lane) const
  {
    pair.key = keys_[lane];
    return canImprove(pair);
  }

  Next compare(const LanePair& pair)
  {
    const ComparedLeaves leaves = walk_.compare(pair);
    ++steps_in_vain_;
    at_least_ = std::max(pair.key, lowest_key_);
    if (walk_.haveTriangles()) {
      eachPairNearTriangles(
          leaves, walk_.a.storage.view, walk_.b.storage.view, walk_.flat(), [this] { return reach(); },
          [&](std::uint32_t i, std::uint32_t j) {
            consider({leaves.a.record(i), leaves.b.record(j)});
            return false;
          });
      return Next::go_on;
    }
    eachPairMaybeNearest(leaves, pairs_.haveRadii(), best_.high, [&](std::uint32_t i, std::uint32_t j) {
      consider({leaves.a.record(i), leaves.b.record(j)});
      return false;
    });
    return Next::go_on;
  }

private:
  /// Opens the pair with the least key, and every few steps dives for a near pair.
  void searchBestFirst()
  {
    SearchPulse pulse({}, queue_.size(), walk_.work);
    std::optional<LanePair> next;
    std::uint32_t next_dive = 0, wait = kStepsBetweenDives;
    double high_before = kInfinity;
    for (std::uint32_t steps = 0;; ++steps) {
      const bool dives_on = next && diving_;
      if (!next) {
        if (std::exchange(diving_, false)) {
          wait = best_.high < high_before ? kStepsBetweenDives : 2 * wait;
          next_dive = steps + wait;
        }
        if (queue_.isEmpty()) return;
        next = queue_.pop();
        if (!mayImprove(*next)) { // pairs left in the queue may improve at most by their record numbers
          if (next->key <= best_.to_beat && !queue_.isEmpty()) {
            next.reset();
            continue;
          }
          queue_.clear();
          return;
        }
        diving_ = steps >= next_dive;
        high_before = best_.high;
      }
      if (isOver(*next, steps, dives_on)) {
        left_over_ = std::min(left_over_, std::min(next->key, queue_.least()));
        if (!goal_.rule.mayStop()) queue_.push(alone(*next));
        diving_ = false;
        return;
      }
      pulse.step(queue_.size());
      if (isSmall(*next)) {
        considerOneOf(*next);
        if (!canImprove(*next)) {
          next.reset();
          continue;
        }
        if (diving_ && isDeepEnough(*next)) {
          queue_.push(alone(*next));
          next.reset();
          continue;
        }
      }
      next = openNearestNext(*next);
    }
  }

  /// Whether the gaps of all pairs of points below differ by no more than the tolerance. Where a budget may stop the
  /// search: whether any of these pairs is likely to make the interval narrower.
  bool isSmall(const LanePair& pair) const
  {
    if (!goal_.rule.mayStop()) return goal_.tolerance > 0.0 && 2.0 * walk_.radiiOf(pair) <= goal_.tolerance;
    return walk_.radiiOf(pair) <= widthBefore(pair);
  }

  /// Whether a dive for a nearer pair than the one considered is so deep that raising the interval's lower end gains
  /// more. A budget may end before a leaf is reached. (The factor was chosen from 2 to 16 by intervals after equal
  /// work.)
  bool isDeepEnough(const LanePair& pair) const
  {
    return goal_.rule.mayStop() && 6.0 * walk_.radiiOf(pair) <= widthBefore(pair);
  }

  /// The width of the interval if the search stopped before this pair.
  double widthBefore(const LanePair& next) const
  {
    return best_.high - std::max(std::min(next.key, queue_.least()), lowest_key_);
  }

  /// Whether to search best first no more.
  bool isOver(const LanePair& next, std::uint32_t steps, bool dives_on)
  {
    if (!goal_.rule.mayStop()) return steps >= kStepsAlone;
    return settled_ || stop_check_.isOver() ||
           (!dives_on && goal_.rule.deepest != StopRule::kNever && walk_.levelToOpen(next) > goal_.rule.deepest);
  }

  static WaitingChildren alone(const LanePair& pair)
  {
    WaitingChildren one{pair, true, static_cast<std::uint8_t>(1u << pair.a.lane), {}};
    one.keys[pair.a.lane] = pair.key;
    return one;
  }

  /// Opens a pair and queues its children, except one that comes next.
  std::optional<LanePair> openNearestNext(const LanePair& pair)
  {
    const Opened which = walk_.choose(pair);
    if (which == Opened::neither) {
      compare(pair);
      return std::nullopt;
    }
    if (!opens(pair, which)) return std::nullopt;
    walk_.template step<true>(pair, which, reach(), step_);
    if (step_.near == 0) return std::nullopt;
    opened(pair, which, step_);
    WaitingChildren children{PairWalk::childOf(pair, which, step_, 0), which == Opened::a, 0, {}};
    std::copy_n(keys_, kLanes, children.keys);
    const std::uint32_t improving = improvingOf(children);
    children.left = static_cast<std::uint8_t>(diving_ ? step_.near : improving);
    if (children.left == 0) return std::nullopt;
    const std::uint32_t lane = children.nearest();
    const LanePair nearest = children.child(lane);
    const bool improves = (improving >> lane & 1u) != 0;
    const bool goes_on = diving_ ? improves || nearest.key < best_.high : nearest.key <= queue_.least();
    children.left = static_cast<std::uint8_t>(goes_on ? improving & ~(1u << lane) : improving);
    if (children.left != 0) queue_.push(children);
    if (diving_ && goal_.rule.mayStop() && walk_.work.leaf_pairs == 0) considerIfMuchNearer(nearest, step_.gap[lane]);
    return goes_on ? std::optional(nearest) : std::nullopt;
  }

  /// Considers a pair of points below spheres whose centres are much nearer than the best pair. For the first dive,
  /// which a budget may end early.
  void considerIfMuchNearer(const LanePair& pair, float between_centers)
  {
    const double between = static_cast<double>(between_centers) * walk_.b.frame(pair.b.space).unit;
    if (between < 0.7 * best_.high) considerOneOf(pair);
  }

  /// Considers one of the pairs below, for a bound from above. It is passed over where doubles do not tell it from the
  /// best: ties, of which a cloud and its copy have thousands, are for leaves to decide.
  void considerOneOf(const LanePair& pair)
  {
    const PointPair one = walk_.lowest(pair);
    if (best_.pair && !pairs_.ofTriangles()) {
      const RecordDistance::Pair posed = pairs_.posed(one);
      const double high = pairs_.distance.enclose(posed).high, radii = posed.radius_p + posed.radius_q;
      if (!(high - radii + kDoubleMargin * (high + radii) < best_.low)) return;
    }
    at_least_ = std::max(pair.key, lowest_key_);
    consider(one);
  }

  /// Whether a pair whose turn has come can improve; looks closer where steps were in vain.
  bool mayImprove(const LanePair& pair)
  {
    none_nearer_ = false;
    const bool in_vain = planes_.policy.mayAsk() || steps_in_vain_ >= steps_to_look_round_;
    return canImprove(pair) && (HWY_LIKELY(!in_vain) || !best_.pair || mayImproveAmongTies(pair));
  }

  /// Whether a pair can improve where bounds tell little: among ties, and what doubles hardly tell from them.
  /// @pre there is a best pair (where distances are limited, it may be found late)
  HWY_NOINLINE bool mayImproveAmongTies(const LanePair& pair)
  {
    if (!has_looked_round_ && steps_in_vain_ >= steps_to_look_round_) lookRound();
    return canImprove(pair) && !(planes_.policy.mayAsk() && isSettledByPlanes(pair));
  }

  /// Compares each record of the best pair with all of the other cloud. It costs half of what was done in vain before.
  void lookRound()
  {
    has_looked_round_ = true;
    if (goal_.rule.mayStop() || !pairs_.ofTriangles()) return;
    at_least_ = lowest_key_;
    const auto each = [](const Spaces& side, const auto& visit) {
      for (std::size_t voxel = 0; voxel < side.storage.voxel_count; ++voxel) side.storage.forEachRecord(voxel, visit);
    };
    const std::uint32_t of_a = best_.pair->a;
    WorkPulse pulse(walk_.work);
    each(walk_.b, [&](std::uint32_t j) { pulse.look(), consider({of_a, j}); });
    const std::uint32_t of_b = best_.pair->b;
    each(walk_.a, [&](std::uint32_t i) { pulse.look(), consider({i, of_b}); });
    looked_round_ = of_b;
    planes_of_ = kInfinity;
  }

  /// Whether nothing below a pair is nearer than the best pair, and nothing as near has smaller record numbers. Planes
  /// between the best pair's nearest places tell this exactly where bounds cannot. Planes of a farther pair tell less,
  /// but nothing wrong.
  bool isSettledByPlanes(const LanePair& pair)
  {
    if (best_.high < planes_of_) {
      planes_of_ = best_.high;
      planes_.lay(*best_.pair, 0.0, looked_round_);
    }
    const auto touching = planes_.touching(walk_.child(walk_.a, pair.a), walk_.child(walk_.b, pair.b));
    none_nearer_ = touching.has_value();
    if (!none_nearer_) return false;
    const PointPair first = firstAmong(*touching);
    if (goal_.tolerance > 0.0 || !(first < *best_.pair)) return true;
    at_least_ = std::max(pair.key, lowest_key_);
    consider(first);
    return !(first < *best_.pair);
  }

  /// The children that can improve, among those that the last step found near.
  std::uint32_t improvingOf(const WaitingChildren& children) const
  {
    std::uint32_t improving = 0, unsure = step_.near;
    if (HWY_LIKELY(static_cast<double>(lowest_key_) < best_.to_beat)) {
      const float limit = roundUp(best_.to_beat);
      improving = lanesBelow(children.keys, limit) & step_.near;
      unsure = static_cast<double>(limit) == best_.to_beat ? step_.near & ~improving : 0;
    }
    for (const std::uint32_t lane : Bits(unsure))
      if (canImprove(children.child(lane))) improving |= 1u << lane;
    return improving;
  }

  void consider(PointPair candidate)
  {
    if (take(candidate)) others_.tell(best_, pairs_);
  }

  const ScratchLease<PairStack> kept_stack_;
  std::vector<LanePair>& stack_ = (*kept_stack_).pairs; ///< of the depth-first search; empty before it
  PairWalk::Step step_;
  PairQueue queue_{lowest_key_};
  alignas(32) float keys_[kLanes] = {}; ///< of the children that the last step tested
  bool diving_ = false;
  StopCheck stop_check_;
  Others others_;
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
