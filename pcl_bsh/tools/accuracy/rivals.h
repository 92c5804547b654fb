// SPDX-License-Identifier: BSD-3-Clause
// Settings side by side: PCL's ways and ours, and ours among themselves.
#pragma once

#include "study.h"

#include <vector>

namespace pcl_bsh::accuracy {

/// One of PCL's ways to the smallest distance, and what of ours answers it.
struct Rival {
  const Measurement* peer;
  /// Of the settings certified to at most the error that was measured of the peer, the fastest; null: there is none.
  const Measurement* ours;

  bool isMet() const { return ours && ours->seconds.median <= peer->seconds.median; }
};

/// One for each measurement of a peer, in their order.
std::vector<Rival> rivalsOf(const Study& study);

/// A setting that another one makes needless: it is no wider, and faster by more than times vary.
struct Beaten {
  const Measurement* setting;
  const Measurement* by; ///< the fastest of those
};

/// Of ours, for the smallest distance. @param noise the share of a time that says nothing, >= 0
std::vector<Beaten> beatenOf(const Study& study, double noise = 0.05);

} // namespace pcl_bsh::accuracy
