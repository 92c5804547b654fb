// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/geometry/relative_frame.h>
#include <pcl_bsh/query/collide.h>

#include <cmath>

namespace pcl_bsh {

/// At which distances a request lets points collide: always up to `clearance`, never beyond `accepted`.
struct Acceptance {
  explicit Acceptance(const CollisionRequest& request)
  : clearance(request.clearance),
    accepted(request.clearance),
    proven(request.accuracy.isProven())
  {
    if (request.accuracy.mode == Accuracy::Mode::tolerance && request.accuracy.value > 0.0)
      accepted = std::max(clearance, std::nextafter(clearance + request.accuracy.value, 0.0));
  }

  DistanceBand band(const RelativeFrame& frame) const
  {
    if (!proven) return frame.bandUnproven(clearance);
    if (accepted == clearance) return frame.band(clearance);
    // Whatever lies between is one or the other; pairs that neither bound can tell are still decided exactly.
    return {frame.band(accepted).hit, frame.band(clearance).miss};
  }

  double clearance;
  double accepted;
  bool proven;
};

} // namespace pcl_bsh
