// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <limits>

namespace pcl_bsh::robots {

/// How far a rotation may be from one.
inline constexpr double kRigid = 1e-12;

inline bool isRigid(const Eigen::Isometry3d& pose)
{
  const Eigen::Matrix3d r = pose.linear();
  return pose.matrix().allFinite() && r.determinant() > 0.0 &&
         (r.transpose() * r - Eigen::Matrix3d::Identity()).norm() <= kRigid;
}

/// Factor of bounds that are made once or are sums of a few terms. Pays for their rounding, and for rotations that are
/// not quite.
inline constexpr double kOutward = 1.0 + 1e-9;

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

} // namespace pcl_bsh::robots
