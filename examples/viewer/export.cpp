// SPDX-License-Identifier: BSD-3-Clause
#include "export.h"

#include "actors.h"
#include "cli/step.h"
#include "text.h"

#include <pcl_bsh/vtk/cloud_data.h>
#include <pcl_bsh/vtk/hierarchy_data.h>
#include <pcl_bsh/vtk/path_data.h>
#include <pcl_bsh/vtk/write_data.h>

#include <vtkNew.h>
#include <vtkPolyData.h>

namespace pcl_bsh::view {
namespace {

/// A cloud with all that is known of its points, in its own frame.
vtkSmartPointer<vtkPolyData> known(CloudActor& cloud, const std::vector<std::uint8_t>& flags)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->ShallowCopy(cloud.leftOut() > 0 ? &cloud.all() : &cloud.data()); // a picture may leave points out, a file not
  if (!flags.empty()) vtk::addArray(*data, "collision", flags);
  return data;
}

vtkSmartPointer<vtkPolyData> knownScan(CloudActor& cloud, const World& world, const Findings& findings,
                                       std::size_t step)
{
  const auto data = known(cloud, findings.flags[0]);
  if (const auto values = world.scan().field("intensity")) vtk::addArray(*data, "intensity", *values);
  if (!findings.known) return data;
  if (const auto distances = world.distances(step); !distances.empty()) vtk::addArray(*data, "distance", distances);
  if (const auto poses = world.firstPoses(); !poses.empty()) vtk::addArray(*data, "first_pose", poses);
  return data;
}

} // namespace

void exportTo(const std::filesystem::path& path, const World& world, std::vector<CloudActor>& clouds,
              const Findings& findings, std::size_t at, unsigned level)
{
  cli::Step step("Writing " + path.string());
  const auto scan = knownScan(clouds[0], world, findings, at);
  if (path.extension() == ".vtp") {
    vtk::writeVtp(*scan, path);
    step.done(grouped(static_cast<std::size_t>(scan->GetNumberOfPoints())) + " points");
    return;
  }
  std::vector<vtk::NamedData> blocks;
  for (std::size_t i = 0; i < world.things().size(); ++i) {
    const Thing& thing = world.things()[i];
    const Eigen::Isometry3d pose = world.poseOf(i, at);
    const auto spheres = vtk::sphereData(*thing.hierarchy, level);
    blocks.emplace_back(thing.name, posed(i == 0 ? scan : known(clouds[i], findings.flags[i]), pose));
    blocks.emplace_back(thing.name + " spheres", posed(spheres, pose));
    blocks.emplace_back(thing.name + " sphere glyphs", posed(vtk::sphereGlyphs(*spheres), pose));
    blocks.emplace_back(thing.name + " voxels", posed(vtk::voxelBoxes(*thing.hierarchy), pose));
    blocks.emplace_back(thing.name + " cells", posed(vtk::cellBoxes(*thing.hierarchy, level), pose));
  }
  for (const auto& way : world.ways(at).poses) blocks.emplace_back("path", vtk::pathData(way));
  vtk::writeVtm(blocks, path);
  step.done(std::to_string(blocks.size()) + " blocks");
}

} // namespace pcl_bsh::view
