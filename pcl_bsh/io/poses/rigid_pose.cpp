// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/poses/rigid_pose.h>

#include <pcl_bsh/geometry/polar_decomposition.h>
#include <pcl_bsh/query/request_check.h>

#include <Eigen/LU>

#include <sstream>

namespace pcl_bsh::io {

RigidPose nearestRigid(const Eigen::Isometry3d& given)
{
  const Eigen::Matrix3d matrix = given.linear();
  const double deviation = (matrix.transpose() * matrix - Eigen::Matrix3d::Identity()).norm();
  const bool refused = !given.matrix().allFinite() || given.matrix().row(3) != Eigen::RowVector4d(0, 0, 0, 1) ||
                       !(deviation <= printed_rigidity) || matrix.determinant() < 0;
  if (refused || deviation <= rigidity_tolerance) return {given, 0};
  RigidPose rigid{given, deviation};
  rigid.pose.linear() = PolarDecomposition(matrix).rotation;
  return rigid;
}

std::string nearestRotationWarning(double deviation)
{
  std::ostringstream text;
  text << "|R'R - I| is " << deviation << ", as few digits leave it: the nearest rotation is used: print more digits";
  return text.str();
}

} // namespace pcl_bsh::io
