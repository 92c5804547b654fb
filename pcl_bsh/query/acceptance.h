// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/geometry/relative_frame.h>
#include <pcl_bsh/query/accuracy.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {

/// At which distances a request lets points collide: always up to `clearance`, never beyond `accepted`.
struct Acceptance {
  Acceptance(double asked, const Accuracy& accuracy) : clearance(asked), accepted(asked), proven(accuracy.isProven())
  {
    if (accuracy.mode == Accuracy::Mode::tolerance && accuracy.value > 0.0)
      accepted = std::max(clearance, std::nextafter(clearance + accuracy.value, 0.0));
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
    return {bandOf(accepted).hit, bandOf(clearance).miss};
  }

  double clearance;
  double accepted;
  bool proven;
};

} // namespace pcl_bsh
