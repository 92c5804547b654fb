// SPDX-License-Identifier: BSD-3-Clause
// The oracle of neighbors.h: every query again, point by point in exact arithmetic.
#pragma once

#include <pcl_bsh/neighbors/neighbors.h>

namespace pcl_bsh::brute_force {

/// Same contracts as their namesakes in neighbors.h.
std::size_t radiusSearch(const SphereHierarchy& cloud, const Point3& query, double radius, Neighbors& found,
                         const RadiusOptions& options = {});
std::size_t nearestKSearch(const SphereHierarchy& cloud, const Point3& query, std::size_t k, Neighbors& found);
bool anyInRadius(const SphereHierarchy& cloud, const Point3& query, double radius);
std::size_t boxSearch(const SphereHierarchy& cloud, const Point3& low, const Point3& high,
                      std::vector<std::int32_t>& indices);

} // namespace pcl_bsh::brute_force
