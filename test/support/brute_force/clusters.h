// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/clusters/clusters.h>

namespace pcl_bsh::brute_force {

/// The oracle, pair by pair in exact arithmetic; it checks no argument.
Clusters euclideanClusters(const SphereHierarchy& cloud, double distance);

} // namespace pcl_bsh::brute_force
