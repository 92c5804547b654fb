// SPDX-License-Identifier: BSD-3-Clause
// A rigid vehicle on two pivots that both stand on the axis.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/track/axis.h>

#include <Eigen/Geometry>

#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Where the second pivot stands: behind the first along the axis, as far from it in space as `pivots` says.
/// @throws InvalidInput where the axis does not hold both
double rearPivotOf(const Axis& axis, double pivots, double front);

/// Where the first pivot stands, when the second one is at `rear`. @throws InvalidInput as rearPivotOf()
double frontPivotOf(const Axis& axis, double pivots, double rear);

/// The pose of the vehicle in the axis' coordinates. The vehicle's own frame has its origin midway between its pivots,
/// x towards the first one, y to the left and z up; it leans by the mean of the cants at both pivots.
Eigen::Isometry3d poseOnPivots(const Axis& axis, double pivots, double front);

/// Poses whose first pivots stand at the distances from `first` to `last`, `step` apart, and at `last`.
/// @throws InvalidInput as rearPivotOf() does, and for a step that is no length
std::vector<Eigen::Isometry3d> posesAlong(const Axis& axis, double pivots, double first, double last, double step);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
