// SPDX-License-Identifier: BSD-3-Clause
// Which points belong together? Euclidean clusters of one cloud, through its hierarchy.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/query/effort.h>
#include <pcl_bsh/query/result.h>

#include <cstdint>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The clusters of a cloud, numbered from 0.
struct Clusters {
  std::vector<std::int32_t>
      of; ///< one per record of the view: number of its cluster; kNothing: no finite point of the view
  std::vector<std::size_t> sizes; ///< points of each cluster
  Work work;
};

/// Two points belong to the same cluster iff a chain of the cloud's points leads from one to the other in steps of
/// `distance` at most, decided exactly, by one thread. Clusters are numbered by their smallest records. Radii play no
/// part.
/// @throws std::invalid_argument unless the distance is finite and >= 0, and the accuracy exact. Cancelled.
Clusters euclideanClusters(const SphereHierarchy& cloud, double distance, const Effort& effort = {});

/// Fills a result, whose memory is used again; it is empty after an exception.
void euclideanClusters(const SphereHierarchy& cloud, double distance, Clusters& result, const Effort& effort = {});
} // namespace pcl_bsh
PCL_BSH_EXPORT_END
