// SPDX-License-Identifier: BSD-3-Clause
// Matrices as files have them: one rule for poses, for transforms of scans and for rotations of sensors.
//
// Up to rigidity_tolerance from a rotation they are taken as they are. Up to printed_rigidity the nearest rotation
// takes their place, with a warning: with six digits they are no longer rigid enough for a query. Others are refused.
#pragma once

#include <Eigen/Geometry>

#include <string>

namespace pcl_bsh::io {

/// The greatest |R'R - I| of a printed matrix that is not refused. Four digits leave no more, and an intended scale
/// leaves far more.
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

/// Returns the given pose where a query takes it, and where it is too far from rigid, so that the query refuses it.
/// Otherwise the nearest rotation replaces its linear part.
RigidPose nearestRigid(const Eigen::Isometry3d& given);

/// A warning of one line that the nearest rotation took the place of a matrix.
std::string nearestRotationWarning(double deviation);

} // namespace pcl_bsh::io
