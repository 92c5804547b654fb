// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/distances/point_distances.h>

namespace pcl_bsh {

/// @throws InvalidInput naming the value: a greatest distance that is negative or NaN, an accuracy or a pose
void check(const Placed& a, const Placed& b, const PointDistancesRequest& request);

/// Sets what is said of all points together from the distances of the single ones.
/// @pre `distance` and `nearest` are set
void findGreatest(const Placed& a, const Placed& b, PointDistances& result);

/// Sets what is said of both directions together from what is said of each.
void findHausdorff(const Placed& a, const Placed& b, SymmetricDistances& result);

} // namespace pcl_bsh
