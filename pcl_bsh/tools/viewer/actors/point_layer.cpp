// SPDX-License-Identifier: BSD-3-Clause
#include "point_layer.h"

#include "actors.h"

#include <pcl_bsh/vtk/cloud_data.h>

#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

namespace pcl_bsh::viewer {
namespace {

constexpr vtkIdType points_while_moving = 300'000;

void setData(vtkActor& actor, vtkPolyData* data)
{
  vtkPolyDataMapper::SafeDownCast(actor.GetMapper())->SetInputData(data);
}

} // namespace

PointLayer::PointLayer(vtkRenderer& renderer, float size, bool in_front)
: data_(vtkSmartPointer<vtkPolyData>::New()),
  all_(actorOf(data_)),
  few_(actorOf(data_))
{
  // VTK moves all points by -8 once any are to be moved at all: the others stay where they are.
  vtkMapper::SetResolveCoincidentTopologyToPolygonOffset();
  few_->SetProperty(all_->GetProperty());
  all_->GetProperty()->SetPointSize(size);
  for (vtkActor* actor : {all_.Get(), few_.Get()}) {
    actor->GetMapper()->SetRelativeCoincidentTopologyPointOffsetParameter(in_front ? -8.0 : 8.0);
    renderer.AddActor(actor);
  }
  setMoving(false);
}

void PointLayer::show(const vtkSmartPointer<vtkPolyData>& data)
{
  data_ = data;
  setData(*all_, data_);
  few_is_old_ = true;
  if (few_->GetVisibility() != 0) setMoving(true);
}

void PointLayer::place(const Eigen::Isometry3d& pose)
{
  const auto matrix = matrixOf(pose);
  all_->SetUserMatrix(matrix);
  few_->SetUserMatrix(matrix);
}

void PointLayer::cut(const Cut& plane)
{
  viewer::cut(*all_, plane);
  viewer::cut(*few_, plane);
}

void PointLayer::setMoving(bool moving)
{
  if (moving && few_is_old_) {
    const auto few = vtk::thinned(*data_, points_while_moving);
    if (few->GetPointData()->HasArray("colors") != 0) few->GetPointData()->SetActiveScalars("colors");
    setData(*few_, few);
    few_is_old_ = false;
  }
  all_->SetVisibility(!moving && !hidden_);
  few_->SetVisibility(moving && !hidden_);
}

void PointLayer::setVisible(bool visible)
{
  all_->SetVisibility(visible && !hidden_);
}

void PointLayer::remove(vtkRenderer& renderer)
{
  renderer.RemoveActor(all_);
  renderer.RemoveActor(few_);
}

void PointLayer::hide()
{
  hidden_ = true;
  setMoving(false);
}

} // namespace pcl_bsh::viewer
