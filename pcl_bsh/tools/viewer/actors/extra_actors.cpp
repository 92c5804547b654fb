// SPDX-License-Identifier: BSD-3-Clause
#include "extra_actors.h"

#include "sphere_actors.h"

#include <pcl_bsh/vtk/hierarchy_data.h>

#include <vtkMapper.h>
#include <vtkProperty.h>

#include <algorithm>
#include <iterator>

namespace pcl_bsh::viewer {
namespace {

void addWires(PropGroup& group, vtkPolyData& boxes, const Eigen::Isometry3d& pose, const Color& color)
{
  const auto actor = actorOf(&boxes);
  actor->GetMapper()->ScalarVisibilityOff();
  setColor(*actor, color);
  actor->GetProperty()->SetOpacity(0.6);
  actor->SetUserMatrix(matrixOf(pose));
  group.add(actor);
}

/// Opened spheres are drawn as their children, so each place is drawn once.
void addTraced(PropGroup& group, const std::vector<TracedSphere>& all, const Eigen::Isometry3d& pose)
{
  for (const SphereFate fate : {SphereFate::pruned, SphereFate::kept, SphereFate::compared}) {
    std::vector<TracedSphere> some;
    std::copy_if(all.begin(), all.end(), std::back_inserter(some),
                 [fate](const TracedSphere& sphere) { return sphere.fate == fate; });
    const double opacity = fate == SphereFate::compared ? 0.6 : fate == SphereFate::kept ? 0.3 : 0.12;
    addSpheres(group, *vtk::traceData(some), pose,
               std::vector<Color>(some.size(), fate_colors[static_cast<std::size_t>(fate)]), opacity);
  }
}

} // namespace

void addExtras(PropGroup& group, const ViewContent& content, const Extras& extras, std::size_t step)
{
  for (std::size_t i = 0; i < content.viewedClouds().size(); ++i) {
    const SphereHierarchy& hierarchy = *content.viewedClouds()[i].hierarchy;
    const Eigen::Isometry3d pose = content.poseOf(i, step);
    if (extras.level) {
      const auto spheres = vtk::sphereData(hierarchy, *extras.level);
      const std::vector<Color> colors(static_cast<std::size_t>(spheres->GetNumberOfPoints()), sphere_color);
      addSpheres(group, *spheres, pose, colors, 0.16);
    }
    if (extras.voxels) addWires(group, *vtk::voxelBoxes(hierarchy), pose, voxel_color);
    if (extras.cells) addWires(group, *vtk::cellBoxes(hierarchy, extras.level.value_or(1)), pose, cell_color);
  }
  if (!extras.trace) return;
  for (const Trace& query : content.traces(step)) {
    addTraced(group, query.trace.a, content.poseOf(query.a, step));
    addTraced(group, query.trace.b, content.poseOf(query.b, step));
  }
}

} // namespace pcl_bsh::viewer
