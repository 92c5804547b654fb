// SPDX-License-Identifier: BSD-3-Clause
// The oracle: every pair of points in exact arithmetic. Quadratic; for tests and for doubt.
#pragma once

#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/export.h>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::brute_force {

/// Same contract as its namesake, but that it is exact whatever the accuracy, takes one thread and reports no progress.
/// Work counts one exact decision per pair looked at.
PointDistances pointDistances(const Placed& a, const Placed& b, const PointDistancesRequest& request = {});

} // namespace pcl_bsh::brute_force
PCL_BSH_EXPORT_END
