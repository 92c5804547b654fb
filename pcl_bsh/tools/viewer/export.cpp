// SPDX-License-Identifier: BSD-3-Clause
#include "render_view.h"

#include <pcl_bsh/tools/cli/step.h>
#include <pcl_bsh/tools/viewer/actors/text.h>

#include <pcl_bsh/vtk/cloud_data.h>
#include <pcl_bsh/vtk/contact_data.h>
#include <pcl_bsh/vtk/hierarchy_data.h>
#include <pcl_bsh/vtk/path_data.h>
#include <pcl_bsh/vtk/surface_data.h>
#include <pcl_bsh/vtk/write_data.h>

#include <vtkNew.h>
#include <vtkPolyData.h>

namespace pcl_bsh::viewer {
namespace {

/// Adds values of triangles, or of points where the cloud has no triangles.
template <class Value>
void addValues(const ViewedCloud& viewed, vtkPolyData& data, const std::string& name, const std::vector<Value>& values)
{
  viewed.hasTriangles() ? vtk::addTriangleArray(data, name, values) : vtk::addArray(data, name, values);
}

/// A cloud with all that is known of its points, or a surface with that of its triangles, in its own frame.
vtkSmartPointer<vtkPolyData> known(const ViewedCloud& viewed, const CloudActor& cloud,
                                   const std::vector<Verdict>& flags)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->ShallowCopy(cloud.leftOut() > 0 ? &cloud.all() : &cloud.data()); // a picture may leave points out, a file not
  if (!flags.empty()) addValues(viewed, *data, "collision", numbersOf(flags));
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

void RenderView::exportTo(const std::filesystem::path& path) const
{
  cli::Step step("Writing " + path.string());
  const auto scan = knownScan(*clouds_[0], content_, collisions_, step_);
  if (path.extension() == ".vtp") {
    vtk::writeVtp(*scan, path);
    const vtkIdType written = content_.scan().hasTriangles() ? scan->GetNumberOfCells() : scan->GetNumberOfPoints();
    step.done(groupedCount(static_cast<std::size_t>(written), content_.scan().partName()));
    return;
  }
  const unsigned level = extras_.level.value_or(0);
  std::vector<vtk::NamedData> blocks;
  for (std::size_t i = 0; i < content_.viewedClouds().size(); ++i) {
    const ViewedCloud& viewed = content_.viewedClouds()[i];
    const Eigen::Isometry3d pose = content_.poseOf(i, step_);
    const auto spheres = vtk::sphereData(*viewed.hierarchy, level);
    blocks.emplace_back(viewed.name, posed(i == 0 ? scan : known(viewed, *clouds_[i], collisions_.flags[i]), pose));
    blocks.emplace_back(viewed.name + " spheres", posed(spheres, pose));
    blocks.emplace_back(viewed.name + " sphere glyphs", posed(vtk::sphereGlyphs(*spheres), pose));
    blocks.emplace_back(viewed.name + " voxels", posed(vtk::voxelBoxes(*viewed.hierarchy), pose));
    blocks.emplace_back(viewed.name + " cells", posed(vtk::cellBoxes(*viewed.hierarchy, level), pose));
  }
  if (const std::vector<Contact> contacts = content_.contacts(step_); !contacts.empty()) {
    blocks.emplace_back("contacts", vtk::contactData(contacts));
    blocks.emplace_back("contact arrows", vtk::contactArrows(*blocks.back().second, arrow_length_));
  }
  for (const auto& motion : content_.paths(step_).poses) blocks.emplace_back("path", vtk::pathData(motion));
  vtk::writeVtm(blocks, path);
  step.done(counted(blocks.size(), "block"));
}

} // namespace pcl_bsh::viewer
