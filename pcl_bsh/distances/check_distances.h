// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/distances/point_distances.h>

namespace pcl_bsh {

/// @throws InvalidInput naming the value: a max_distance that is negative or NaN, an accuracy or a pose
void check(const Placed& a, const Placed& b, const PointDistancesRequest& request);

} // namespace pcl_bsh
