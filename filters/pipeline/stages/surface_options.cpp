// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/stages/other_cloud.h>
#include <pcl_bsh/filters/pipeline/stages/surface_options.h>
#include <pcl_bsh/geometry/invalid_input.h>

namespace pcl_bsh::pipeline {
namespace {

/// Whose tolerance comes on top of the surface's.
std::string besideSurface(const Accuracy& accuracy, bool swept)
{
  if (swept) return "swept motion";
  if (!accuracy.isProven()) return "the accuracy float (without proof)";
  return accuracy.isExact() || accuracy.stopsEarly() ? "" : "the accuracy " + accuracy.text();
}

} // namespace

io::Obstacle SurfaceOptions::obstacleOf(const OtherCloud& other, double clearance, const Accuracy& accuracy, bool swept,
                                        const Stage& stage, std::vector<std::string>& told) const
{
  io::Obstacle obstacle;
  try {
    obstacle = io::Obstacle(pointsOf(other.cloud), other.cloud->triangles, {surface_tolerance, vertices_only},
                            clearance, [&stage](double) { return !stage.isCancelled(); });
  }
  catch (const InvalidInput& error) {
    if (error.input() == Input::surface && error.value()) throw OptionError("surface_tolerance", error.advice());
    throw OptionError("obstacle", other.name + ": " + error.advice());
  }
  for (const std::string& remark : obstacle.remarks()) told.push_back("obstacle: " + remark);
  if (obstacle.isSurface()) told.push_back(io::promiseOf(obstacle, besideSurface(accuracy, swept)));
  return obstacle;
}

} // namespace pcl_bsh::pipeline
