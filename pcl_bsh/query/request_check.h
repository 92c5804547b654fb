// SPDX-License-Identifier: BSD-3-Clause
// Checks of requests that all queries share. Each throws InvalidInput naming the value.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/points_view.h>
#include <pcl_bsh/query/effort.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <optional>
#include <string>

namespace pcl_bsh {

/// How large |R'R - I| (Frobenius norm) of a pose's rotation R may be: far above a pose once kept in float32, far below
/// a scale meant as one.
inline constexpr double rigidity_tolerance = 1e-6;

/// Refuses a clearance that is negative or not finite.
PCL_BSH_EXPORT_INTERNAL void checkClearance(double clearance);

/// Refuses a greatest distance that is negative or NaN.
PCL_BSH_EXPORT_INTERNAL void checkMaxDistance(double max_distance);

/// Refuses a value of the accuracy that is negative or not finite.
PCL_BSH_EXPORT_INTERNAL void checkAccuracy(const Accuracy& accuracy);

/// Refuses an accuracy other than exact, for a query that knows no other.
PCL_BSH_EXPORT_INTERNAL void checkExact(const Effort& effort);

/// Whether a pose is finite, has the last row 0 0 0 1, does not mirror, and has |R'R - I| <= tolerance.
PCL_BSH_EXPORT_INTERNAL bool isRigid(const Eigen::Isometry3d& pose, double tolerance = rigidity_tolerance);

/// Refuses a pose that is not rigid, called `name` in the message. @param index which of several it is
PCL_BSH_EXPORT_INTERNAL void checkPose(const std::string& name, const Eigen::Isometry3d& pose,
                                       const std::optional<std::size_t>& index = std::nullopt);

/// Refuses poses of two clouds, a and b, that are not rigid.
inline void checkPoses(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b)
{
  checkPose("pose of a", a);
  checkPose("pose of b", b);
}

} // namespace pcl_bsh
