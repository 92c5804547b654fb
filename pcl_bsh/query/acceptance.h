// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/geometry/relative_frame.h>
#include <pcl_bsh/query/accuracy.h>
#include <pcl_bsh/query/reach.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh {

/// At which distances a request lets points collide: what is up to `accepted` may count as colliding, what is beyond
/// `clearance` may not count if it is beyond `accepted`, too. As measured and exact, the two are one; a tolerance
/// raises `accepted`, and where places are uncertain it is the least reach of all pairs and `clearance` the greatest;
/// floats alone cannot tell these pairs apart.
struct Acceptance {
  Acceptance(double asked, const Accuracy& accuracy) : Acceptance({asked, {}, {}, Places::measured}, accuracy) {}

  Acceptance(const Reach& reach, const Accuracy& accuracy)
  : clearance(std::max(0.0, reach.most)),
    accepted(reach.least),
    surely_within(reach.most),
    surely_beyond(reach.least),
    proven(accuracy.isProven() || reach.least != reach.most),
    exact(proven)
  {
    if (accuracy.mode != Accuracy::Mode::tolerance || !(accuracy.value > 0.0)) return;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    accepted = std::max(reach.least, std::nextafter(reach.least + accuracy.value, -infinity));
    surely_within = reach.least == reach.most ? accepted : std::nextafter(reach.most + accuracy.value, infinity);
    exact = false;
  }

  DistanceBand band(const RelativeFrame& frame) const
  {
    return proven ? provenBand([&](double distance) { return frame.band(distance); }) : frame.bandUnproven(clearance);
  }

  /// @param bandOf a distance
  template <class BandOf>
  DistanceBand provenBand(const BandOf& bandOf) const
  {
    if (accepted == clearance) return bandOf(clearance);
    // Whatever lies between is one or the other; pairs that neither bound decides are still decided exactly.
    return {accepted < 0.0 ? -1.0f : bandOf(accepted).hit, bandOf(clearance).miss};
  }

  double clearance;
  double accepted;
  double surely_within; ///< the distance of what counts as colliding
  double surely_beyond; ///< that of what does not, except where stops are early
  bool proven;
  bool exact; ///< no pair's answer is open
};

} // namespace pcl_bsh
