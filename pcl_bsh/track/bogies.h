// SPDX-License-Identifier: BSD-3-Clause
// A rigid vehicle on two pivots that both stand on the axis.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/track/axis.h>

#include <Eigen/Geometry>

#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Distance along the axis of the second pivot, behind the first at `front`. They are `pivots` apart in space.
/// @throws InvalidInput where the axis does not hold both
double rearPivotOf(const Axis& axis, double pivots, double front);

/// Distance along the axis of the first pivot, when the second is at `rear`. @throws InvalidInput as rearPivotOf()
double frontPivotOf(const Axis& axis, double pivots, double rear);

/// The pose of the vehicle in the axis' coordinates. The vehicle's own frame has its origin midway between its pivots,
/// x towards the first one, y to the left and z up; it leans by the mean of the cants at both pivots.
Eigen::Isometry3d poseOnPivots(const Axis& axis, double pivots, double front);

/// Poses whose first pivots stand at the distances from `first` to `last`, `step` apart, and at `last`.
/// @throws InvalidInput as rearPivotOf() does, for a step not above 0, for last < first, and for 10^7 steps or more
std::vector<Eigen::Isometry3d> posesAlong(const Axis& axis, double pivots, double first, double last, double step);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
