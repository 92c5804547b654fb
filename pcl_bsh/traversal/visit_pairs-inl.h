// SPDX-License-Identifier: BSD-3-Clause
// The loop over pairs of nodes that queries for pairs of points share: a visitor says what is of interest, and what to
// do with two leaves.

#if defined(PCL_BSH_TRAVERSAL_VISIT_PAIRS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAVERSAL_VISIT_PAIRS_INL_H_
#undef PCL_BSH_TRAVERSAL_VISIT_PAIRS_INL_H_
#else
#define PCL_BSH_TRAVERSAL_VISIT_PAIRS_INL_H_
#endif

#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/traversal/pair_walk-inl.h>

#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// A visitor's answer: go on, leave the pair out, or end the walk.
enum class Next : std::uint8_t { go_on, prune, stop };

/// Defaults of visitors of pairs.
struct PairVisitor {
  explicit PairVisitor(const Watch& by = {}) : watch(by) {}

  static constexpr bool kBounds = false; ///< whether steps tell how far apart children are

  const Watch watch; ///< observes the walk, and may cancel it

  /// Called before a pair is expanded. prune: it is of no interest any more; stop: the walk ends with it on the stack.
  static Next visit(const LanePair&) { return Next::go_on; }

  /// Whether to open a pair that is not a pair of leaves.
  static bool opens(const LanePair&, Opened) { return true; }

  /// Called after the children of one side of a pair were tested: go on with them, or stop.
  static Next opened(const LanePair&, Opened, const PairWalk::Step&) { return Next::go_on; }

  /// Whether a child that is near has to be visited. May change the child's key, which orders the children.
  static bool keep(LanePair&, Opened, const PairWalk::Step&, std::uint32_t) { return true; }
};

/// Has two leaves compared, or opens a pair and calls add(child) for the children that the visitor keeps.
/// @tparam Visitor a PairVisitor with `double reach()`, as PairWalk::step() takes it, and `Next compare(pair)` of
/// leaves
template <class Pair, class Visitor, class Add>
Next expand(PairWalk& walk, const Pair& pair, PairWalk::Step& step, Visitor& visitor, const Add& add)
{
  const Opened opened = walk.choose(pair);
  if (opened == Opened::neither) return visitor.compare(pair);
  if (!visitor.opens(pair, opened)) return Next::prune;
  walk.template step<Visitor::kBounds>(pair, opened, visitor.reach(), step);
  if (visitor.opened(pair, opened, step) == Next::stop) return Next::stop;
  for (const std::uint32_t lane : Bits(step.near)) {
    Pair child = PairWalk::childOf(pair, opened, step, lane);
    if (visitor.keep(child, opened, step, lane)) add(child);
  }
  return Next::go_on;
}

/// The loop over pairs: depth first, the nearest children first, until the stack is empty or the visitor stops.
/// @throws Cancelled
template <class Pair, class Visitor>
void visitPairs(PairWalk& walk, std::vector<Pair>& stack, Visitor& visitor)
{
  PairWalk::Step step;
  SearchPulse pulse(visitor.watch, stack.size(), walk.work);
  while (!stack.empty()) {
    pulse.step(stack.size());
    const Pair pair = stack.back();
    const Next next = visitor.visit(pair);
    if (next == Next::stop) return;
    stack.pop_back();
    if (next == Next::prune) continue;
    const std::size_t from = stack.size();
    if (expand(walk, pair, step, visitor, [&stack](const Pair& child) { stack.push_back(child); }) == Next::stop)
      return;
    nearestLast(stack, from);
  }
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
