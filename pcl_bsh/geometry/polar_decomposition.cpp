// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/polar_decomposition.h>

#include <Eigen/LU>

namespace pcl_bsh {

/// Newton's iteration for the orthogonal factor (Higham, Computing the Polar Decomposition, 1986). A singular value s
/// becomes (s + 1 / s) / 2, which squares its distance from 1: from 1e-4 to rounding in two steps.
PolarDecomposition::PolarDecomposition(const Eigen::Matrix3d& linear) : rotation(linear)
{
  for (int i = 0; i < 2; ++i) rotation = (0.5 * (rotation + rotation.inverse().transpose())).eval();
  const Eigen::Matrix3d product = rotation.transpose() * linear;
  stretch = 0.5 * (product + product.transpose());
}

} // namespace pcl_bsh
