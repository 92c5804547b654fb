// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/query/trajectory.h>

#include <cstddef>
#include <optional>
#include <string>

namespace pcl_bsh {

/// How large |R'R - I| (Frobenius norm) of a pose's rotation R may be: far above a pose once kept in float32, far below
/// a scale meant as one.
inline constexpr double rigidity_tolerance = 1e-6;

/// Every query calls this before anything else, whatever it computes.
/// @throws InvalidInput naming the value: a clearance that is negative or not finite; a pose that is not
///   finite, whose last row is not 0 0 0 1, that mirrors, or whose rotation R has |R'R - I| > 1e-6 (Frobenius norm).
void check(const Placed& a, const Placed& b, const CollisionRequest& request);

/// The same for a trajectory, with its tolerance, its pivot, and what its accuracy cannot tell; a pose of the model is
/// named by its index.
void check(const Placed& scan, const std::vector<Eigen::Isometry3d>& model_poses, const TrajectoryRequest& request);

/// Whether a trajectory's result would hold anything.
bool asksForAnything(const TrajectoryRequest& request);

/// The part of it that judges one pose, called `name` in the message. @param index which of several it is
void checkPose(const std::string& name, const Eigen::Isometry3d& pose,
               const std::optional<std::size_t>& index = std::nullopt);

} // namespace pcl_bsh
