// SPDX-License-Identifier: BSD-3-Clause
// Finds the greatest of the distances of single points, and the Hausdorff distance from both directions.
#pragma once

#include <pcl_bsh/distances/point_distances.h>

namespace pcl_bsh {

/// Sets `measured`, `greatest` and `greatest_pair` from the distances of single points.
/// @pre `distance` and `closest_point` are set
void findGreatest(const Placed& a, const Placed& b, PointDistances& result);

/// Sets the greatest of both directions and its pair from those of each, of which one may be missing.
void findGreatestOfBoth(const Placed& a, const Placed& b, SymmetricDistances& result);

/// Does findGreatestOfBoth() where every point has a distance; otherwise the Hausdorff distance is not known, so NaN.
void findHausdorff(const Placed& a, const Placed& b, SymmetricDistances& result);

} // namespace pcl_bsh
