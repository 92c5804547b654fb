// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/query/request_check.h>

#include <pcl_bsh/geometry/invalid_input.h>

#include <cmath>
#include <limits>
#include <locale>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

namespace pcl_bsh {
namespace {

template <class... Parts>
std::string text(const Parts&... parts)
{
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  (stream << ... << parts);
  return stream.str();
}

void checkClearance(double clearance)
{
  if (std::isfinite(clearance) && clearance >= 0.0) return;
  throw InvalidInput(Input::clearance, "clearance", text(clearance), "give a finite length >= 0").withValue(clearance);
}

void checkAccuracy(const Accuracy& accuracy)
{
  if (std::isfinite(accuracy.value) && accuracy.value >= 0.0) return;
  throw InvalidInput(Input::accuracy, "accuracy", accuracy.text(), "give a finite number >= 0")
      .withValue(accuracy.value);
}

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

/// What checkPose() asks for.
bool isRigid(const Eigen::Isometry3d& pose)
{
  return pose.matrix().allFinite() && pose.matrix().row(3) == Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0) &&
         deviationFromRigid(pose.linear()) <= rigidity_tolerance && pose.linear().determinant() >= 0.0;
}

} // namespace

void checkPose(const std::string& name, const Eigen::Isometry3d& pose, const std::optional<std::size_t>& index)
{
  const Eigen::Matrix4d& matrix = pose.matrix();
  const Eigen::IOFormat one_line(6, Eigen::DontAlignCols, " ", "; ");
  if (!matrix.allFinite())
    throw poseError(name, index, text("not finite (", matrix.format(one_line), ")"), "give a rigid transform");
  if (matrix.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) {
    throw poseError(name, index, text("last row is ", matrix.row(3).format(one_line)),
                    "give a rigid transform, with last row 0 0 0 1");
  }
  const Eigen::Matrix3d rotation = pose.linear();
  const double deviation = deviationFromRigid(rotation);
  if (!(deviation <= rigidity_tolerance)) {
    throw poseError(name, index, text("not rigid, |R'R - I| is ", deviation, " (", rotation.format(one_line), ")"),
                    text("give a rotation without scale or shear, within ", rigidity_tolerance))
        .withValue(deviation);
  }
  if (rotation.determinant() < 0.0)
    throw poseError(name, index, text("a mirror (", rotation.format(one_line), ")"), "give a rotation");
}

void check(const Placed& a, const Placed& b, const CollisionRequest& request)
{
  checkClearance(request.clearance);
  checkAccuracy(request.accuracy);
  checkPose("pose of a", a.pose);
  checkPose("pose of b", b.pose);
}

void check(const Placed& scan, const std::vector<Eigen::Isometry3d>& model_poses, const TrajectoryRequest& request)
{
  checkClearance(request.clearance);
  checkAccuracy(request.accuracy);
  if (request.swept && !request.accuracy.isExact())
    throw InvalidInput(Input::accuracy, "accuracy", request.accuracy.text(),
                       "swept motion has a tolerance of its own: give exact");
  const bool more = request.distances || request.first_poses || request.closest_poses || request.pose_summaries;
  if (request.accuracy.stopsEarly() && more)
    throw InvalidInput(Input::accuracy, "accuracy", request.accuracy.text(),
                       "decides which points collide, not when and how near: ask for flags alone, or give exact, float "
                       "or tolerance=LENGTH");
  if (request.swept && !(std::isfinite(*request.swept) && *request.swept > 0.0))
    throw InvalidInput(Input::swept, "tolerance of the swept motion", text(*request.swept), "give a finite length > 0")
        .withValue(*request.swept);
  if (request.swept && request.pose_summaries)
    throw InvalidInput(Input::summaries, "pose_summaries", "are of poses, swept motion is of what is between",
                       "ask for one of them");
  for (const double coordinate : request.pivot)
    if (!std::isfinite(coordinate))
      throw InvalidInput(Input::pivot, "pivot", text(coordinate), "give three finite coordinates")
          .withValue(coordinate);
  constexpr std::size_t most_poses = std::numeric_limits<std::int32_t>::max();
  if (model_poses.size() > most_poses)
    throw InvalidInput(Input::trajectory, "trajectory",
                       text(model_poses.size(), " poses are more than an index can name (", most_poses, ")"));
  checkPose("pose of the scan", scan.pose);
  for (std::size_t k = 0; k < model_poses.size(); ++k)
    if (!isRigid(model_poses[k])) // a name for each of millions would cost as much as the path
      checkPose("pose " + std::to_string(k) + " of the model", model_poses[k], k);
}

bool asksForAnything(const TrajectoryRequest& request)
{
  return request.flags || request.distances || request.first_poses || request.closest_poses || request.pose_summaries ||
         request.swept;
}

} // namespace pcl_bsh
