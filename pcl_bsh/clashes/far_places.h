// SPDX-License-Identifier: BSD-3-Clause
// Where one cloud is far from another, place by place: clusters of its far points.
#pragma once

#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/points_view.h>

#include <cstdint>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Far points that lie together. Coordinates are in the cloud's own frame, lengths in its unit.
struct FarPlace {
  std::vector<std::uint32_t> records;     ///< its points, ascending
  Point3 low = {}, high = {};             ///< its bounding box
  double distance = 0.0;                  ///< the greatest; infinity where a point of it has none within max_distance
  std::uint32_t point = 0;                ///< the record that has it, of several the smallest
  std::uint32_t closest_point = kNothing; ///< the other cloud's nearest to it; kNothing where infinite
};

/// Clusters (euclideanClusters() with that distance) of the finite points that are farther than `beyond` from the other
/// cloud or have no distance. The worst comes first: by greatest distance, then by most points, then by smallest
/// record.
/// @param found of pointDistances() of this cloud, with an accuracy that does not stop early
/// @param beyond >= 0 and not NaN
/// @param cluster_distance finite, > 0
/// @throws std::invalid_argument for another length, or a result of another cloud
std::vector<FarPlace> findFarPlaces(const PointsView& cloud, const PointDistances& found, double beyond,
                                    double cluster_distance);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
