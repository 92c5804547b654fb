// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/geometry/exact_distance.h>
#include <pcl_bsh/traversal/space.h>

namespace pcl_bsh {

/// Decides pairs of points by the coordinates as given, in exact arithmetic.
class PointPairs {
public:
  PointPairs(const Placed& a, const Placed& b, double greatest_distance)
  : clearance(greatest_distance),
    distance(a.pose, b.pose),
    a_(a.hierarchy().view()),
    b_(b.hierarchy().view())
  {
  }

  bool collide(PointPair pair, Work& work) const
  {
    ++work.exact_decisions;
    return distance.compare(a_.point(pair.a), b_.point(pair.b), clearance, a_.radius(pair.a), b_.radius(pair.b)) <= 0;
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

  const double clearance;
  const ExactDistance distance;

private:
  const PointsView& a_;
  const PointsView& b_;
};

} // namespace pcl_bsh
