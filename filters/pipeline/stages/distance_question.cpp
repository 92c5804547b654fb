// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/filters/pipeline/stages/distance_question.h>
#include <pcl_bsh/filters/pipeline/stages/other_cloud.h>

namespace pcl_bsh::pipeline {

std::vector<std::string> DistanceQuestion::check()
{
  std::vector<std::string> warnings;
  checkSurface();
  obstacle_pose_ = rigidPoseOf(pose, warnings);
  try {
    PointDistancesRequest request;
    request.accuracy = Accuracy::parse(accuracy);
    const SphereHierarchy nothing{PointsView{}};
    pointDistances({nothing}, {nothing, obstacle_pose_}, request);
    if (request.accuracy.stopsEarly()) {
      throw OptionError("accuracy", "is '" + accuracy +
                                        "', which leaves points without a distance: give exact or "
                                        "tolerance=LENGTH");
    }
  }
  catch (const InvalidInput& error) {
    throw OptionError(error.input() == Input::accuracy ? "accuracy" : "pose", error.advice());
  }
  return warnings;
}

PointDistancesRequest DistanceQuestion::request(const Stage& stage) const
{
  PointDistancesRequest request;
  if (max_distance) request.max_distance = *max_distance;
  request.accuracy = Accuracy::parse(accuracy);
  request.threads = number_of_threads;
  request.progress = [&stage](double) { return !stage.isCancelled(); };
  return request;
}

} // namespace pcl_bsh::pipeline
