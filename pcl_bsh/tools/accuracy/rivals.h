// SPDX-License-Identifier: BSD-3-Clause
// Settings side by side: PCL's ways and ours, and ours among themselves.
#pragma once

#include "study.h"

#include <vector>

namespace pcl_bsh::accuracy {

/// One of PCL's ways to the smallest distance or to flags, and what of ours answers it: of the settings certified to at
/// most the error that was measured of the peer, the fastest; null: there is none.
struct Rival {
  const Measurement* peer;
  const Measurement* ours; ///< where trees, and thinned clouds, are made before
  const Measurement* once; ///< where they are made for this question

  bool isMet() const { return ours && ours->seconds.median <= peer->seconds.median; }
  bool isMetOnce() const { return once && once->once.median <= peer->once.median; }
};

/// One for each measurement of a peer, in their order. Settings that may flag other points are none of flags.
std::vector<Rival> rivalsOf(const Study& study);

/// A setting that another one makes needless: it is no wider, and faster by more than times vary.
struct Beaten {
  const Measurement* setting;
  const Measurement* by; ///< the fastest of those
};

/// Of ours, for the smallest distance. @param noise the share of a time that says nothing, >= 0
std::vector<Beaten> beatenOf(const Study& study, double noise = 0.05);

} // namespace pcl_bsh::accuracy
