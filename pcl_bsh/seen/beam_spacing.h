// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/seen/beam_tree.h>

namespace pcl_bsh {

/// How far apart the beams of a scan are, in radians: of up to a thousand of them the farther one of the nearest beam
/// above or below and the nearest beside, each within 60 degrees of that way; the median of those. 0: there are not two
/// beams of different directions.
double beamSpacing(const BeamTree& beams);

} // namespace pcl_bsh
