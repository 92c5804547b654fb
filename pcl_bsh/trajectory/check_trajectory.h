// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/trajectory/trajectory.h>

namespace pcl_bsh {

/// Every query along a path calls this before anything else. A pose of the model is named by its index.
/// @throws InvalidInput naming the value: a clearance, accuracy, tolerance, pivot or pose that is not what its
///   declaration asks for; an answer that the accuracy, or swept motion, cannot give; too many poses.
void check(const Placed& scan, const std::vector<Eigen::Isometry3d>& model_poses, const TrajectoryRequest& request);

/// Refuses a tolerance of swept motion that is not finite and > 0.
void checkSwept(double tolerance);

/// Refuses a pivot that is not finite.
void checkPivot(const Point3& pivot);

/// Whether a trajectory's result would hold anything.
bool asksForAnything(const TrajectoryRequest& request);

/// A result for so many records and poses, where nothing collides.
TrajectoryResult allFree(const TrajectoryRequest& request, std::size_t records, std::size_t poses,
                         TrajectoryResult&& memory = {});

} // namespace pcl_bsh
