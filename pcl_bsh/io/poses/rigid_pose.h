// SPDX-License-Identifier: BSD-3-Clause
// Matrices as files have them: one rule for poses, for transforms of scans and for rotations of sensors.
//
// Up to rigidity_tolerance from a rotation they are taken as they are. Up to printed_rigidity the nearest rotation
// takes their place, with a warning: with six digits they are no longer rigid enough for a query. Others are refused.
#pragma once

#include <Eigen/Geometry>

#include <string>

namespace pcl_bsh::io {

/// How far from rigid, |R'R - I|, a printed matrix may be: what four digits leave, far below a scale meant as one.
inline constexpr double printed_rigidity = 1e-4;

/// The linear part of a transform by that rule.
struct RigidPart {
  Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();   ///< what takes the place of the given matrix
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity(); ///< without the scale that is allowed
  double deviation = 0;                                   ///< |R'R - I| where `linear` is not the given matrix, else 0
  std::string wrong;                                      ///< why it is refused, as "mirrors"; empty: it is taken
  bool scales = false;                                    ///< it is refused for a uniform scale alone
};

/// @param allow_scale a positive number times a rotation is taken, too, with that scale
RigidPart rigidPart(const Eigen::Matrix3d& given, bool allow_scale = false);

/// How users allow what RigidPart::scales refuses.
inline constexpr auto remedy_for_scale = "give --allow-scale if that is meant (allow_scale in Python, pipelines and "
                                         "scenes), or write a matrix without scale";

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
