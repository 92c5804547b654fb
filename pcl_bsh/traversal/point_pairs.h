// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/geometry/exact_distance.h>
#include <pcl_bsh/query/pair_reach.h>
#include <pcl_bsh/traversal/space.h>

namespace pcl_bsh {

inline Reach reachBetween(const Placed& a, const Placed& b, double clearance, Places places,
                          const PatchSpacings& patches_of_b = {})
{
  return {clearance, a.hierarchy().storage().uncertainty, b.hierarchy().storage().uncertainty, places, patches_of_b};
}

/// Decides pairs of points by the coordinates as given, in exact arithmetic.
class PointPairs {
public:
  PointPairs(const Placed& a, const Placed& b, double clearance, Places places = Places::measured,
             const PatchSpacings& patches_of_b = {})
  : reach(reachBetween(a, b, clearance, places, patches_of_b)),
    distance(a.pose, b.pose),
    a_(a.hierarchy().view()),
    b_(b.hierarchy().view()),
    of_pairs_(a_, b_, clearance, places, patches_of_b)
  {
  }

  /// Whether the pair's gap is within its reach, at the places that the constructor was told.
  bool collide(PointPair pair, Work& work) const
  {
    ++work.exact_decisions;
    return of_pairs_.holds(distance, pair);
  }

  /// The same of a pair whose squared float distance in a frame is known. Where pairs have reaches of their own, it
  /// decides most of them.
  bool collide(const RelativeFrame& frame, float squared, PointPair pair, Work& work) const
  {
    if (!of_pairs_.isOne()) {
      const auto [least, most] = of_pairs_.around(pair);
      if (most < 0.0 || squared > frame.band(most).miss) return false;
      if (least > 0.0 && squared <= frame.band(least).hit) return true;
    }
    return collide(pair, work);
  }

  ExactDistance::Pair posed(PointPair pair) const
  {
    return {a_.point(pair.a), b_.point(pair.b), a_.radius(pair.a), b_.radius(pair.b)};
  }

  double gap(PointPair pair) const { return distance.gap(posed(pair)); }

  /// Whether the gap of a pair is less than this.
  bool isNearer(PointPair pair, double gap) const
  {
    return distance.compare(a_.point(pair.a), b_.point(pair.b), gap, a_.radius(pair.a), b_.radius(pair.b)) < 0;
  }

  bool haveRadii() const { return a_.radii || b_.radii; }

  const PairReach& ofPairs() const { return of_pairs_; }

  const Reach reach; ///< of all pairs
  const ExactDistance distance;

private:
  const PointsView& a_;
  const PointsView& b_;
  const PairReach of_pairs_;
};

} // namespace pcl_bsh
