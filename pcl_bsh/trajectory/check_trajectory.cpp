// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/trajectory/check_trajectory.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/query/request_check.h>

#include <cmath>
#include <limits>

namespace pcl_bsh {

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
                       "decides which points collide, not when and how near: ask for flags alone, or give exact or "
                       "tolerance=LENGTH");
  if (request.swept) checkSwept(*request.swept);
  if (request.swept && request.pose_summaries)
    throw InvalidInput(Input::summaries, "pose_summaries", "are of poses, swept motion is of what is between",
                       "ask for one of them");
  checkPivot(request.pivot);
  constexpr std::size_t most_poses = std::numeric_limits<std::int32_t>::max();
  if (model_poses.size() > most_poses)
    throw InvalidInput(Input::trajectory, "trajectory",
                       plainText(model_poses.size(), " poses are more than an index can name (", most_poses, ")"));
  checkPose("pose of the scan", scan.pose);
  for (std::size_t k = 0; k < model_poses.size(); ++k)
    if (!isRigid(model_poses[k])) // a name for each of millions would cost as much as the path
      checkPose("pose " + std::to_string(k) + " of the model", model_poses[k], k);
}

void checkSwept(double tolerance)
{
  if (!(std::isfinite(tolerance) && tolerance > 0.0))
    throw InvalidInput(Input::swept, "swept", plainText(tolerance), "give a finite length > 0").withValue(tolerance);
}

void checkPivot(const Point3& pivot)
{
  for (const double coordinate : pivot)
    if (!std::isfinite(coordinate))
      throw InvalidInput(Input::pivot, "pivot", plainText(coordinate), "give three finite coordinates")
          .withValue(coordinate);
}

bool asksForAnything(const TrajectoryRequest& request)
{
  return request.flags || request.distances || request.first_poses || request.closest_poses || request.pose_summaries ||
         request.swept;
}

TrajectoryResult allFree(const TrajectoryRequest& request, std::size_t records, std::size_t poses,
                         TrajectoryResult&& memory)
{
  TrajectoryResult result;
  const auto fill = [&](auto column, bool asked, std::size_t size, auto value) {
    (result.*column).swap(memory.*column);
    (result.*column).assign(asked ? size : 0, value);
  };
  using Result = TrajectoryResult;
  fill(&Result::flags, request.flags, records, Verdict::free);
  fill(&Result::distance, request.distances, records, std::numeric_limits<float>::quiet_NaN());
  fill(&Result::first_pose, request.first_poses, records, kNothing);
  fill(&Result::closest_pose, request.closest_poses, records, kNothing);
  fill(&Result::closest_point, request.distances || request.closest_poses, records, kNothing);
  fill(&Result::poses, request.pose_summaries, poses, PoseSummary());
  return result;
}

} // namespace pcl_bsh
