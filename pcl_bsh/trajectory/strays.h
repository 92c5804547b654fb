// SPDX-License-Identifier: BSD-3-Clause
// Points so far out that along a path they meet none of the others: sentinels, and coordinates gone wrong. One of them
// would leave floats no precision for all of the cloud, and a walk would compare every pair in exact arithmetic.
#pragma once

#include <pcl_bsh/trajectory/trajectory.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace pcl_bsh {

/// Records of a scan and of a model, divided into strays and others. There may be no strays of one. No stray comes
/// within reach of an ordinary point of the other, at any pose.
struct Strays {
  std::vector<std::int32_t> ordinary_scan, stray_scan, ordinary_model, stray_model;
};

/// Returns nothing where no point is so far out, or where strays might meet ordinary points.
std::optional<Strays> findStrays(const Placed& scan, const SphereHierarchy& model,
                                 const std::vector<Eigen::Isometry3d>& model_poses, double clearance);

/// The answers about ordinary points, in `result`, become those about all. @param strays the same question about
/// stray_scan and stray_model alone
void addStrays(TrajectoryResult& result, const TrajectoryResult& strays, const std::vector<std::int32_t>& stray_scan);

} // namespace pcl_bsh
