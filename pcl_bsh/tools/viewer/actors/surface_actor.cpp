// SPDX-License-Identifier: BSD-3-Clause
#include "surface_actor.h"

#include "actors.h"

#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/vtk/surface_data.h>

#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

namespace pcl_bsh::viewer {

vtkSmartPointer<vtkActor> addSurface(const ViewedCloud& viewed, vtkRenderer& renderer, const Color& color)
{
  const auto actor = actorOf(vtk::surfaceData(viewOf(viewed.surface->points()), *viewed.surface->triangles()));
  setColor(*actor, color);
  actor->GetProperty()->LightingOn();
  actor->GetProperty()->SetInterpolationToFlat();
  actor->GetProperty()->SetAmbient(0.3);
  actor->GetProperty()->SetDiffuse(0.7);
  actor->PickableOff();
  renderer.AddActor(actor);
  return actor;
}

} // namespace pcl_bsh::viewer
