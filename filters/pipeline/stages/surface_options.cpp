// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/filters/pipeline/stages/other_cloud.h>
#include <pcl_bsh/filters/pipeline/stages/surface_options.h>
#include <pcl_bsh/geometry/counted.h>
#include <pcl_bsh/io/text/number_text.h>
#include <pcl_bsh/search/cloud_view.h>

namespace pcl_bsh::pipeline {
namespace {

/// Whose tolerance comes on top of the surface's.
std::string besideSurface(const Accuracy& accuracy, bool swept)
{
  if (swept) return "swept motion";
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

void SurfaceOptions::requirePoints(const StageCloud& input) const
{
  if (asksAboutFaces(input))
    throw OptionError("vertices_only", "is false, and the input has faces: the stage knows points alone: give true to "
                                       "ask about its vertices, or read it without faces");
}

std::shared_ptr<const SurfaceCover> SurfaceOptions::coverOfInput(const StageCloud& input, double clearance,
                                                                 const Stage& stage,
                                                                 std::vector<std::string>& told) const
{
  try {
    std::vector<std::string> remarks;
    auto cover = std::make_shared<const SurfaceCover>(io::coverMesh(
        viewOf(input.cloud), *input.triangles, {surface_tolerance, vertices_only, true}, clearance,
        [&stage](double) { return !stage.isCancelled(); }, remarks));
    for (const std::string& remark : remarks) told.push_back("input: " + remark);
    const std::string tolerance = io::numberText(cover->tolerance, std::chars_format::general, 6);
    told.push_back("the input is a surface of " + counted(cover->triangle_count, "triangle") + ", to a tolerance of " +
                   tolerance +
                   ": a free triangle is farther than the clearance from the obstacle for certain, a colliding one is "
                   "within the clearance + " +
                   tolerance);
    return cover;
  }
  catch (const InvalidInput& error) {
    if (error.input() == Input::surface && error.value()) throw OptionError("surface_tolerance", error.advice());
    throw std::invalid_argument("input: " + error.advice());
  }
}

} // namespace pcl_bsh::pipeline
