// SPDX-License-Identifier: BSD-3-Clause
// Matrices of poses as people print them: with six digits they are no longer rigid enough for a query.
#pragma once

#include <Eigen/Geometry>

#include <string>

namespace pcl_bsh::io {

/// How far from rigid, |R'R - I|, a printed matrix may be: what four digits leave, far below a scale meant as one.
inline constexpr double printed_rigidity = 1e-4;

struct RigidPose {
  Eigen::Isometry3d pose;
  double deviation = 0; ///< |R'R - I| of the given matrix where another one took its place, otherwise 0
};

/// The pose as it is where a query takes it, and where not even printed_rigidity holds, for the query to refuse; in
/// between, with the rotation that is nearest to the given matrix.
RigidPose nearestRigid(const Eigen::Isometry3d& given);

/// One line that says so.
std::string nearestRotationWarning(double deviation);

} // namespace pcl_bsh::io
