// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/query/pair_reach.h>
#include <pcl_bsh/traversal/space.h>

#include <limits>

namespace pcl_bsh {

inline Reach reachBetween(const Placed& a, const Placed& b, double clearance, MeantPlaces places,
                          const PatchSpacings& patches_of_b = {})
{
  return {clearance, a.hierarchy().storage().uncertainty, b.hierarchy().storage().uncertainty, places, patches_of_b};
}

/// Decides pairs of records by the coordinates as given, in exact arithmetic.
class PointPairs {
public:
  PointPairs(const Placed& a, const Placed& b, double clearance, MeantPlaces places = MeantPlaces::measured,
             const PatchSpacings& patches_of_b = {})
  : reach(reachBetween(a, b, clearance, places, patches_of_b)),
    distance(a.hierarchy().view(), a.pose, b.hierarchy().view(), b.pose),
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

  /// Decides a pair whose squared float distance in a frame is known. The float distance decides most pairs of points
  /// that have reaches of their own.
  bool collide(const RelativeFrame& frame, float squared, PointPair pair, Work& work) const
  {
    if (!of_pairs_.isOne() && !ofTriangles()) {
      const auto [least, most] = of_pairs_.around(pair);
      if (most < 0.0 || squared > frame.band(most).miss) return false;
      if (least > 0.0 && squared <= frame.band(least).hit) return true;
    }
    return collide(pair, work);
  }

  RecordDistance::Pair posed(PointPair pair) const { return distance.pair(pair); }

  double gap(PointPair pair) const { return distance.gap(posed(pair)); }

  /// Whether the trees are of balls, in place of points.
  bool haveRadii() const { return a_.radii || b_.radii; }

  /// Whether one cloud is of triangles. Gaps of balls are then lower bounds, and prove no collision.
  bool ofTriangles() const { return distance.ofTriangles(); }

  /// Whether gaps may be below 0.
  bool mayOverlap() const { return a_.areBalls() || b_.areBalls(); }

  /// Returns the gap up to which balls collide for certain: Reach::least, or minus infinity beside triangles.
  double surelyOfBalls() const { return ofTriangles() ? -std::numeric_limits<double>::infinity() : reach.least; }

  const PairReach& ofPairs() const { return of_pairs_; }

  const Reach reach; ///< of all pairs
  const RecordDistance distance;

private:
  const PointsView& a_;
  const PointsView& b_;
  const PairReach of_pairs_;
};

} // namespace pcl_bsh
