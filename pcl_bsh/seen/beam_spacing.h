// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/seen/beam_tree.h>

namespace pcl_bsh {

/// The angle between the beams of a scan, in radians; 0 where all beams have one direction. It is a median over up to a
/// thousand beams. Each gives the larger of two angles: to the nearest beam above or below, and to the nearest beside,
/// both within 60 degrees of that way.
double beamSpacing(const BeamTree& beams);

} // namespace pcl_bsh
