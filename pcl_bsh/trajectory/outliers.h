// SPDX-License-Identifier: BSD-3-Clause
// Points so far out that along a path they meet none of the others: sentinels, and coordinates gone wrong. One of them
// would leave floats no precision for all of the cloud, and a walk would compare every pair in exact arithmetic.
#pragma once

#include <pcl_bsh/trajectory/trajectory.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace pcl_bsh {

/// Records of a scan and of a model, divided into outliers and ordinary ones. One of the clouds may have no outliers.
/// No outlier of one cloud comes within reach of an ordinary point of the other, at any pose.
struct Outliers {
  std::vector<std::int32_t> ordinary_scan, outlier_scan, ordinary_model, outlier_model;
};

/// Returns nothing where no point is so far out, or where outliers might meet ordinary points.
std::optional<Outliers> findOutliers(const Placed& scan, const SphereHierarchy& model,
                                     const std::vector<Eigen::Isometry3d>& model_poses, double clearance);

/// Adds the answers about outliers. @param result has the answers about ordinary points, and becomes the result of all.
/// @param outliers the result of the same question about outlier_scan and outlier_model alone
void addOutliers(TrajectoryResult& result, const TrajectoryResult& outliers,
                 const std::vector<std::int32_t>& outlier_scan);

} // namespace pcl_bsh
