// SPDX-License-Identifier: BSD-3-Clause
#include "cloud_actor.h"

#include "actors.h"

#include <vtkMapper.h>
#include <vtkNew.h>
#include <vtkPlane.h>

namespace pcl_bsh::viewer {

void CloudActor::draw(vtkActor& actor)
{
  actors_.emplace_back(&actor);
  renderer_.AddActor(&actor);
}

void CloudActor::place(const Eigen::Isometry3d& pose)
{
  const auto matrix = matrixOf(pose);
  for (const auto& actor : actors_) actor->SetUserMatrix(matrix);
}

void CloudActor::remove()
{
  for (const auto& actor : actors_) renderer_.RemoveActor(actor);
}

void CloudActor::cut(const Cut& plane)
{
  vtkNew<vtkPlane> kept;
  kept->SetOrigin(plane.point.data());
  kept->SetNormal(-plane.normal[0], -plane.normal[1], -plane.normal[2]);
  for (const auto& actor : actors_) actor->GetMapper()->AddClippingPlane(kept);
}

} // namespace pcl_bsh::viewer
