// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/geometry/relative_frame.h>
#include <pcl_bsh/query/accuracy.h>
#include <pcl_bsh/query/reach.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh {

/// The band of a request, as lengths. A pair at a distance up to `hit` may count as colliding. A pair beyond both `hit`
/// and `miss` must not. For measured places and exact answers, both are equal. A tolerance raises `hit`. Where places
/// are uncertain, `hit` is the least reach of all pairs, and `miss` is the greatest.
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

  /// @param bandOf returns the band of a distance
  template <class BandOf>
  DistanceBand band(const BandOf& bandOf) const
  {
    if (hit == miss) return bandOf(miss);
    // Whatever lies between is one or the other; pairs that neither bound decides are still decided exactly.
    return {hit < 0.0 ? -1.0f : bandOf(hit).hit, bandOf(miss).miss};
  }

  double hit;           ///< may be below 0
  double miss;          ///< >= 0
  double surely_within; ///< pairs that count as colliding are no farther apart
  double surely_beyond; ///< pairs that do not count are no nearer, unless the walk stops early
  bool exact = true;    ///< whether no pair may go either way
};

} // namespace pcl_bsh
