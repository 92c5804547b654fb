// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/export.h>

#include <Eigen/Core>

namespace pcl_bsh {

/// linear = rotation * stretch: the rotation nearest to a matrix that is nearly one, and a symmetric matrix. Right to
/// rounding for matrices with |R'R - I| <= 1e-4 and a positive determinant.
struct PCL_BSH_EXPORT_INTERNAL PolarDecomposition {
  explicit PolarDecomposition(const Eigen::Matrix3d& linear);

  Eigen::Matrix3d rotation;
  Eigen::Matrix3d stretch;
};

} // namespace pcl_bsh
