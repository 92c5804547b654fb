// SPDX-License-Identifier: BSD-3-Clause
#include "actors.h"

#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/vtk/surface_data.h>

#include <vtkNew.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkTransform.h>
#include <vtkTransformPolyDataFilter.h>

namespace pcl_bsh::viewer {

vtkSmartPointer<vtkMatrix4x4> matrixOf(const Eigen::Isometry3d& pose)
{
  auto matrix = vtkSmartPointer<vtkMatrix4x4>::New();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) matrix->SetElement(row, column, pose.matrix()(row, column));
  return matrix;
}

vtkSmartPointer<vtkActor> actorOf(vtkPolyData* data)
{
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->LightingOff();
  return actor;
}

void setData(vtkActor& actor, vtkPolyData& data)
{
  vtkPolyDataMapper::SafeDownCast(actor.GetMapper())->SetInputData(&data);
}

void setColor(vtkActor& actor, const Color& color)
{
  const std::array<double, 3> c = fractions(color);
  actor.GetProperty()->SetColor(c[0], c[1], c[2]);
}

vtkSmartPointer<vtkActor> surfaceActor(const ViewedCloud& viewed, const Color& color)
{
  const auto actor = actorOf(vtk::surfaceData(viewOf(viewed.surface->points()), *viewed.surface->triangles()));
  setColor(*actor, color);
  actor->GetProperty()->LightingOn();
  actor->GetProperty()->SetInterpolationToFlat();
  actor->GetProperty()->SetAmbient(0.3);
  actor->GetProperty()->SetDiffuse(0.7);
  return actor;
}

vtkSmartPointer<vtkPolyData> posed(vtkPolyData* data, const Eigen::Isometry3d& pose)
{
  if (data->GetNumberOfPoints() == 0 || pose.isApprox(Eigen::Isometry3d::Identity(), 0.0)) return data;
  vtkNew<vtkTransform> transform;
  transform->SetMatrix(matrixOf(pose));
  vtkNew<vtkTransformPolyDataFilter> filter;
  filter->SetTransform(transform);
  filter->SetInputData(data);
  filter->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  filter->Update();
  return filter->GetOutput();
}

void PropGroup::add(const vtkSmartPointer<vtkProp>& prop)
{
  prop->PickableOff();
  renderer_.AddViewProp(prop);
  props_.push_back(prop);
}

void PropGroup::clear()
{
  for (const auto& prop : props_) renderer_.RemoveViewProp(prop);
  props_.clear();
}

} // namespace pcl_bsh::viewer
