// SPDX-License-Identifier: BSD-3-Clause
#include "export.h"

#include <pcl_bsh/tools/cli/step.h>
#include <pcl_bsh/tools/viewer/actors/actors.h>
#include <pcl_bsh/tools/viewer/actors/text.h>

#include <pcl_bsh/vtk/cloud_data.h>
#include <pcl_bsh/vtk/hierarchy_data.h>
#include <pcl_bsh/vtk/path_data.h>
#include <pcl_bsh/vtk/surface_data.h>
#include <pcl_bsh/vtk/write_data.h>

#include <vtkNew.h>
#include <vtkPolyData.h>

namespace pcl_bsh::viewer {
namespace {

/// Adds values of what the cloud is asked about.
template <class Value>
void addValues(const ViewedCloud& viewed, vtkPolyData& data, const std::string& name, const std::vector<Value>& values)
{
  viewed.hasTriangles() ? vtk::addTriangleArray(data, name, values) : vtk::addArray(data, name, values);
}

/// A cloud with all that is known of its points, or a surface with that of its triangles, in its own frame.
vtkSmartPointer<vtkPolyData> known(const ViewedCloud& viewed, const CloudActor& cloud,
                                   const std::vector<std::uint8_t>& flags)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->ShallowCopy(cloud.leftOut() > 0 ? &cloud.all() : &cloud.data()); // a picture may leave points out, a file not
  if (!flags.empty()) addValues(viewed, *data, "collision", flags);
  return data;
}

vtkSmartPointer<vtkPolyData> knownScan(const CloudActor& cloud, const ViewContent& content,
                                       const StepCollisions& collisions, std::size_t step)
{
  const ViewedCloud& scan = content.scan();
  const auto data = known(scan, cloud, collisions.flags[0]);
  if (const auto values = scan.field("intensity")) addValues(scan, *data, "intensity", *values);
  if (!collisions.known) return data;
  if (const auto distances = content.distances(step); !distances.empty()) addValues(scan, *data, "distance", distances);
  if (const auto poses = content.firstPoses(); !poses.empty()) addValues(scan, *data, "first_pose", poses);
  return data;
}

} // namespace

void exportTo(const std::filesystem::path& path, const ViewContent& content, CloudActors clouds,
              const StepCollisions& collisions, std::size_t at, unsigned level)
{
  cli::Step step("Writing " + path.string());
  const auto scan = knownScan(*clouds[0], content, collisions, at);
  if (path.extension() == ".vtp") {
    vtk::writeVtp(*scan, path);
    const vtkIdType written = content.scan().hasTriangles() ? scan->GetNumberOfCells() : scan->GetNumberOfPoints();
    step.done(grouped(static_cast<std::size_t>(written)) + ' ' + content.scan().partName() + 's');
    return;
  }
  std::vector<vtk::NamedData> blocks;
  for (std::size_t i = 0; i < content.viewedClouds().size(); ++i) {
    const ViewedCloud& viewed = content.viewedClouds()[i];
    const Eigen::Isometry3d pose = content.poseOf(i, at);
    const auto spheres = vtk::sphereData(*viewed.hierarchy, level);
    blocks.emplace_back(viewed.name, posed(i == 0 ? scan : known(viewed, *clouds[i], collisions.flags[i]), pose));
    blocks.emplace_back(viewed.name + " spheres", posed(spheres, pose));
    blocks.emplace_back(viewed.name + " sphere glyphs", posed(vtk::sphereGlyphs(*spheres), pose));
    blocks.emplace_back(viewed.name + " voxels", posed(vtk::voxelBoxes(*viewed.hierarchy), pose));
    blocks.emplace_back(viewed.name + " cells", posed(vtk::cellBoxes(*viewed.hierarchy, level), pose));
  }
  for (const auto& motion : content.paths(at).poses) blocks.emplace_back("path", vtk::pathData(motion));
  vtk::writeVtm(blocks, path);
  step.done(std::to_string(blocks.size()) + " blocks");
}

} // namespace pcl_bsh::viewer
