// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/geometry/relative_frame.h>
#include <pcl_bsh/query/accuracy.h>
#include <pcl_bsh/query/reach.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh {

/// The band of a request, as lengths: what is up to `hit` may count as colliding, what is beyond `miss` may not count
/// if it is beyond `hit`, too. As measured and exact, the two are one; a tolerance raises `hit`, and where places are
/// uncertain it is the least reach of all pairs and `miss` the greatest.
struct LengthBand {
  LengthBand(const Reach& reach, const Accuracy& accuracy)
  : hit(reach.least),
    miss(reach.length()),
    surely_within(reach.most),
    surely_beyond(reach.least)
  {
    if (accuracy.mode != Accuracy::Mode::tolerance || !(accuracy.value > 0.0)) return;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    hit = std::max(reach.least, std::nextafter(reach.least + accuracy.value, -infinity));
    surely_within = reach.least == reach.most ? hit : std::nextafter(reach.most + accuracy.value, infinity);
    exact = false;
  }

  DistanceBand band(const RelativeFrame& frame) const
  {
    return band([&](double distance) { return frame.band(distance); });
  }

  /// @param bandOf a distance
  template <class BandOf>
  DistanceBand band(const BandOf& bandOf) const
  {
    if (hit == miss) return bandOf(miss);
    // Whatever lies between is one or the other; pairs that neither bound decides are still decided exactly.
    return {hit < 0.0 ? -1.0f : bandOf(hit).hit, bandOf(miss).miss};
  }

  double hit;           ///< may be below 0
  double miss;          ///< >= 0
  double surely_within; ///< the distance of what counts as colliding
  double surely_beyond; ///< that of what does not, except where stops are early
  bool exact = true;    ///< no pair's answer is open
};

} // namespace pcl_bsh
