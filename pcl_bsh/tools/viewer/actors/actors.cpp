// SPDX-License-Identifier: BSD-3-Clause
#include "actors.h"

#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkTransform.h>
#include <vtkTransformPolyDataFilter.h>
#include <vtkUnsignedCharArray.h>

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

void setColor(vtkActor& actor, const Color& color)
{
  const std::array<double, 3> c = fractions(color);
  actor.GetProperty()->SetColor(c[0], c[1], c[2]);
}

void setColors(vtkPolyData& data, const std::vector<Color>& colors)
{
  auto* const index = vtkIntArray::SafeDownCast(data.GetPointData()->GetArray("index"));
  vtkNew<vtkUnsignedCharArray> array;
  array->SetName("colors");
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(data.GetNumberOfPoints());
  for (vtkIdType i = 0; i < data.GetNumberOfPoints(); ++i)
    array->SetTypedTuple(i, colors[static_cast<std::size_t>(index ? index->GetValue(i) : i)].data());
  data.GetPointData()->SetScalars(array);
}

void cut(vtkActor& actor, const Cut& plane)
{
  vtkNew<vtkPlane> kept;
  kept->SetOrigin(plane.point.data());
  kept->SetNormal(-plane.normal[0], -plane.normal[1], -plane.normal[2]);
  actor.GetMapper()->AddClippingPlane(kept);
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
