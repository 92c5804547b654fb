// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/poses/rigid_pose.h>

#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/geometry/polar_decomposition.h>
#include <pcl_bsh/query/request_check.h>

#include <Eigen/LU>
#include <Eigen/SVD>

#include <cmath>
#include <sstream>

namespace pcl_bsh::io {

namespace {

double deviationOf(const Eigen::Matrix3d& matrix)
{
  return (matrix.transpose() * matrix - Eigen::Matrix3d::Identity()).norm();
}

/// The scale by which a matrix must be divided for a determinant of 1 or -1. 0 where it is singular to a millionth.
/// @pre it is finite
double scaleOf(const Eigen::Matrix3d& matrix)
{
  const double largest = matrix.cwiseAbs().maxCoeff();
  if (!(largest > 0)) return 0;
  const Eigen::Matrix3d unit = matrix / largest; // whose determinant is no denormal number
  const Eigen::Vector3d sizes = Eigen::JacobiSVD<Eigen::Matrix3d>(unit).singularValues();
  constexpr double flat = 1e-6;
  return sizes[2] > flat * sizes[0] ? largest * std::cbrt(sizes.prod()) : 0;
}

} // namespace

RigidPart rigidPart(const Eigen::Matrix3d& given, bool allow_scale)
{
  RigidPart part;
  if (!given.allFinite()) {
    part.wrong = "is not finite";
    return part;
  }
  const double scale = scaleOf(given);
  const Eigen::Matrix3d without_scale = given / (scale > 0 ? scale : 1);
  const bool is_similar = scale > 0 && deviationOf(without_scale) <= printed_rigidity;
  const double deviation = deviationOf(allow_scale && is_similar ? without_scale : given);
  if (scale == 0)
    part.wrong = "flattens space: it is singular";
  else if (without_scale.determinant() < 0)
    part.wrong = "mirrors";
  else if (!is_similar && !(deviation <= printed_rigidity))
    part.wrong = plainText("shears or scales unevenly: |R'R - I| is ", deviation);
  else if (!(deviation <= printed_rigidity)) {
    part.wrong = plainText("scales by ", scale);
    part.scales = true;
  }
  if (!part.wrong.empty()) return part;
  part.linear = given;
  part.rotation = PolarDecomposition(allow_scale ? without_scale : given).rotation;
  if (deviation <= rigidity_tolerance) return part;
  part.deviation = deviation;
  part.linear = allow_scale ? Eigen::Matrix3d(scale * part.rotation) : part.rotation;
  return part;
}

RigidPose nearestRigid(const Eigen::Isometry3d& given)
{
  RigidPose rigid{given, 0};
  if (!given.matrix().allFinite() || given.matrix().row(3) != Eigen::RowVector4d(0, 0, 0, 1)) return rigid;
  const RigidPart part = rigidPart(given.linear());
  if (part.wrong.empty()) rigid = {given, part.deviation};
  if (rigid.deviation > 0) rigid.pose.linear() = part.linear;
  return rigid;
}

std::string nearestRotationWarning(double deviation)
{
  std::ostringstream text;
  text << "|R'R - I| is " << deviation << ", as few digits leave it: the nearest rotation is used: print more digits";
  return text.str();
}

} // namespace pcl_bsh::io
