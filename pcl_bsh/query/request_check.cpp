// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/query/request_check.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>

#include <cmath>
#include <utility>

namespace pcl_bsh {
namespace {

InvalidInput poseError(const std::string& name, const std::optional<std::size_t>& index, std::string wrong,
                       std::string remedy)
{
  InvalidInput error(Input::pose, name, std::move(wrong), std::move(remedy));
  if (index) error.withIndex(*index);
  return error;
}

double deviationFromRigid(const Eigen::Matrix3d& rotation)
{
  return (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm();
}

} // namespace

void checkClearance(double clearance)
{
  if (std::isfinite(clearance) && clearance >= 0.0) return;
  throw InvalidInput(Input::clearance, "clearance", plainText(clearance), "give a finite length >= 0")
      .withValue(clearance);
}

void checkMaxDistance(double max_distance)
{
  if (max_distance >= 0.0) return;
  throw InvalidInput(Input::max_distance, "max_distance", plainText(max_distance), "give a length >= 0, or infinity")
      .withValue(max_distance);
}

void checkAccuracy(const Accuracy& accuracy)
{
  if (std::isfinite(accuracy.value) && accuracy.value >= 0.0) return;
  throw InvalidInput(Input::accuracy, "accuracy", accuracy.text(), "give a finite number >= 0")
      .withValue(accuracy.value);
}

void checkExact(const Effort& effort)
{
  if (effort.accuracy.isExact()) return;
  throw InvalidInput(Input::accuracy, "accuracy", effort.accuracy.text() + " is less than this query gives",
                     "give exact: it knows no other")
      .withValue(effort.accuracy.value);
}

bool isRigid(const Eigen::Isometry3d& pose, double tolerance)
{
  return pose.matrix().allFinite() && pose.matrix().row(3) == Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0) &&
         deviationFromRigid(pose.linear()) <= tolerance && pose.linear().determinant() >= 0.0;
}

void checkPose(const std::string& name, const Eigen::Isometry3d& pose, const std::optional<std::size_t>& index)
{
  if (isRigid(pose)) return;
  const Eigen::Matrix4d& matrix = pose.matrix();
  const Eigen::IOFormat one_line(6, Eigen::DontAlignCols, " ", "; ");
  if (!matrix.allFinite())
    throw poseError(name, index, plainText("not finite (", matrix.format(one_line), ")"), "give a rigid transform");
  if (matrix.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) {
    throw poseError(name, index, plainText("last row is ", matrix.row(3).format(one_line)),
                    "give a rigid transform, with last row 0 0 0 1");
  }
  const Eigen::Matrix3d rotation = pose.linear();
  const double deviation = deviationFromRigid(rotation);
  if (!(deviation <= rigidity_tolerance))
    throw poseError(name, index, plainText("not rigid, |R'R - I| is ", deviation, " (", rotation.format(one_line), ")"),
                    plainText("give a rotation without scale or shear, within ", rigidity_tolerance))
        .withValue(deviation);
  throw poseError(name, index, plainText("a mirror (", rotation.format(one_line), ")"), "give a rotation");
}

} // namespace pcl_bsh
