// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/flags/collision_flags.h>

namespace pcl_bsh {

/// Every query of flags calls this before anything else, whatever it computes.
/// @throws InvalidInput naming the value: a clearance or an accuracy that is negative or not finite; a spacing that is;
///   poses that checkPoses() refuses
void check(const Placed& a, const Placed& b, const FlagsRequest& request);

} // namespace pcl_bsh
