// SPDX-License-Identifier: BSD-3-Clause
// Voxels that are walked in passes, each farther down, until all is decided or a rule ends it.
#pragma once

#include <pcl_bsh/base/kept_scratch.h>
#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/query/stop_rule.h>
#include <pcl_bsh/query/work.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_bsh {

/// Memory that queries use one after another; a ScratchLease lends it.
template <class Place, class Part>
struct PassScratch {
  std::vector<Place> places;
  std::vector<Part> parts;

  std::size_t bytes() const noexcept { return places.capacity() * sizeof(Place) + parts.capacity() * sizeof(Part); }
};

/// @tparam Place a voxel with something undecided
/// @tparam Part the result of one walk through it: its `work`, and whether something was left `undecided`
template <class Place, class Part>
class VoxelPasses {
public:
  /// @param work sums the work of all walks
  /// @param progress counts them
  VoxelPasses(unsigned threads, Work& work, Progress& progress) : threads_(threads), work_(work), progress_(progress)
  {
    places.clear();
  }

  /// How many walks all passes of a rule take at most, for the progress.
  std::size_t steps(const StopRule& rule) const { return places.size() * (rule.mayStop() ? rule.passes().size() : 1); }

  /// Sphere tests of all passes so far.
  std::uint64_t spent() const { return spent_; }

  /// Makes all passes of a rule.
  /// @param tests budget of all of them, tests already spent included
  /// @param walk Part(rule, place), from several threads at once for different places
  /// @throws Cancelled
  template <class Walk>
  void run(StopRule rule, std::uint64_t tests, const Walk& walk)
  {
    if (!rule.mayStop()) return pass(rule, walk);
    for (const std::uint64_t deepest : rule.passes()) {
      rule.deepest = deepest;
      if (tests != StopRule::kNever) rule.node_pairs = tests - std::min(tests, spent_);
      pass(rule, walk);
    }
  }

private:
  /// Walks what was left undecided. The rule's sphere tests are for this pass.
  template <class Walk>
  void pass(const StopRule& rule, const Walk& walk)
  {
    const auto watched = [&](const StopRule& own, const Place& place) {
      if (progress_.stopped()) return Part();
      const Part part = walk(own, place);
      progress_.step();
      return part;
    };
    parts_.assign(places.size(), Part());
    if (rule.node_pairs == StopRule::kNever) {
      parallelFor(places.size(), threads_, [&](std::size_t i) { parts_[i] = watched(rule, places[i]); });
    }
    else { // one after another: the next one gets the tests that one leaves
      StopRule own = rule;
      for (std::size_t i = 0; i < places.size(); ++i) {
        parts_[i] = watched(own, places[i]);
        own.node_pairs -= std::min(own.node_pairs, parts_[i].work.node_pairs);
      }
    }
    progress_.throwIfStopped();
    std::size_t left = 0;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      work_ += parts_[i].work;
      spent_ += parts_[i].work.node_pairs;
      if (parts_[i].undecided && rule.mayStop()) places[left++] = places[i];
    }
    places.resize(left);
  }

  const ScratchLease<PassScratch<Place, Part>> scratch_;
  std::vector<Part>& parts_ = (*scratch_).parts; ///< of the last pass
  const unsigned threads_;
  Work& work_;
  Progress& progress_;
  std::uint64_t spent_ = 0;

public:
  std::vector<Place>& places = (*scratch_).places; ///< to be set before the first pass
};

/// Both clouds share the budget: a gets half of it, b the rest; a timed rule then lets a go on.
/// @tparam Side has spent() and passes(rule, tests), as VoxelPasses
template <class Side>
void passBothWithin(Side& a, Side& b, const StopRule& rule)
{
  const StopRule half = rule.part(0.5);
  a.passes(half, half.node_pairs);
  // A count of tests gives b more than half (and one) only when a is done; otherwise a has spent its half. Then a is
  // done with any larger count, too. So a larger count decides all that a smaller one decides.
  const std::uint64_t left = rule.node_pairs - std::min(rule.node_pairs, a.spent());
  b.passes(rule, std::max(half.node_pairs, left));
  if (rule.isTimed()) a.passes(rule, StopRule::kNever);
}

} // namespace pcl_bsh
