// SPDX-License-Identifier: BSD-3-Clause
// What follows from the distances of single points: the greatest, and of both directions the Hausdorff distance.
#pragma once

#include <pcl_bsh/distances/point_distances.h>

namespace pcl_bsh {

/// Sets what is said of all points together from the distances of the single ones.
/// @pre `distance` and `closest_point` are set
void findGreatest(const Placed& a, const Placed& b, PointDistances& result);

/// Sets the greatest of both directions and its pair from those of each, of which one may be missing.
void findGreatestOfBoth(const Placed& a, const Placed& b, SymmetricDistances& result);

/// The same where every point has a distance; otherwise it is not known.
void findHausdorff(const Placed& a, const Placed& b, SymmetricDistances& result);

} // namespace pcl_bsh
